// A layer of the network for a tile of samples: forwards, backwards, and the gradient of its
// weights.
#pragma once

#include "memory.h"

namespace nisp {

// Outputs and vectors of samples whose sums a layer keeps in registers on its way forwards; outputs
// and inputs whose products it keeps for the gradient.
constexpr int FORWARD_OUTPUTS = MANY_REGISTERS ? 6 : 4;
constexpr int FORWARD_VECTORS = MANY_REGISTERS ? 4 : VECTOR_LENGTH > 4 ? 3 : 2;
constexpr int GRADIENT_OUTPUTS = MANY_REGISTERS ? 6 : 4;
constexpr int GRADIENT_INPUTS = MANY_REGISTERS ? 4 : 3;
// A tile is filled up to a multiple of so many samples.
constexpr int SAMPLES_AT_A_TIME = FORWARD_VECTORS * VECTOR_LENGTH;

// Samples that go through the network together, about 256: their activations stay in the
// second-level cache, and a quarter of a usual batch is one tile.
constexpr int TILE = rounded_up(256, SAMPLES_AT_A_TIME);
// A row of one number of each sample of a tile. A power of two would put all rows into few sets of
// the cache.
constexpr int ROW = TILE + 16;

// A weight matrix, or its transpose: the weight from input i to output o is at
// data[o * by_output + i * by_input].
struct Weights {
    const float* data;
    size_t by_output, by_input;
};

// Sums over all inputs of the weights times a few vectors of samples, for a few outputs. Every
// vector that is loaded serves all outputs, every weight all vectors.
template <int OUTPUTS, class Finish>
inline void dense_block(const Weights& weights, const float* bias, int inputs, const float* input,
                        int output, int sample, Finish& finish) {
    Vector sums[OUTPUTS][FORWARD_VECTORS];
    for (int o = 0; o < OUTPUTS; o++)
        for (int v = 0; v < FORWARD_VECTORS; v++) sums[o][v] = bias ? all(bias[output + o]) : Vector{};
    const float* first = weights.data + output * weights.by_output;
    const float* row = input + sample;
    for (int i = 0; i < inputs; i++, row += ROW, first += weights.by_input) {
        Vector values[FORWARD_VECTORS];
        for (int v = 0; v < FORWARD_VECTORS; v++) values[v] = load(row + v * VECTOR_LENGTH);
        for (int o = 0; o < OUTPUTS; o++) {
            const Vector weight = all(first[o * weights.by_output]);
            for (int v = 0; v < FORWARD_VECTORS; v++) sums[o][v] += weight * values[v];
        }
    }
    for (int o = 0; o < OUTPUTS; o++)
        for (int v = 0; v < FORWARD_VECTORS; v++)
            finish(static_cast<size_t>(output + o) * ROW + sample + v * VECTOR_LENGTH, sums[o][v]);
}

// What a layer says of the first `samples` of a tile before its activation, handed over as
// finish(place in a tile's rows, vector). Without a bias where it is null.
template <class Finish>
inline void dense(const Weights& weights, const float* bias, int outputs, int inputs,
                  const float* input, int samples, Finish finish) {
    const int blocks = (outputs + FORWARD_OUTPUTS - 1) / FORWARD_OUTPUTS;
    // Samples outside: their inputs stay in the first-level cache for all outputs.
    for (int sample = 0; sample < samples; sample += SAMPLES_AT_A_TIME)
        for (int k = 0; k < blocks; k++) {
            const int output = outputs * k / blocks, count = outputs * (k + 1) / blocks - output;
            with_constant<FORWARD_OUTPUTS>(count, [&](auto OUTPUTS) {
                dense_block<OUTPUTS>(weights, bias, inputs, input, output, sample, finish);
            });
        }
}

// Sums over the samples of each of OUTPUTS rows times each of INPUTS rows.
template <int OUTPUTS, int INPUTS>
inline void row_products(const float* outputs, const float* inputs, int samples, float* sums) {
    Vector products[OUTPUTS * INPUTS] = {};
    for (int s = 0; s < samples; s += VECTOR_LENGTH) {
        Vector derivatives[OUTPUTS];
        for (int o = 0; o < OUTPUTS; o++) derivatives[o] = load(outputs + o * ROW + s);
        for (int i = 0; i < INPUTS; i++) {
            const Vector input = load(inputs + i * ROW + s);
            for (int o = 0; o < OUTPUTS; o++) products[o * INPUTS + i] += derivatives[o] * input;
        }
    }
    sums_of<OUTPUTS * INPUTS>(products, sums);
}

// Adds to `gradient`, rows of `inputs` numbers for each output, the sum over the samples of the
// loss' derivative by that output times the input.
inline void add_weight_gradient(const float* derivatives, int outputs, const float* input, int inputs,
                                int samples, float* gradient) {
    const int down = (outputs + GRADIENT_OUTPUTS - 1) / GRADIENT_OUTPUTS;
    const int across = (inputs + GRADIENT_INPUTS - 1) / GRADIENT_INPUTS;
    for (int k = 0; k < down; k++) {
        const int output = outputs * k / down, rows = outputs * (k + 1) / down - output;
        with_constant<GRADIENT_OUTPUTS>(rows, [&](auto OUTPUTS) {
            for (int m = 0; m < across; m++) {
                const int first = inputs * m / across, columns = inputs * (m + 1) / across - first;
                with_constant<GRADIENT_INPUTS>(columns, [&](auto INPUTS) {
                    float sums[OUTPUTS * INPUTS];
                    row_products<OUTPUTS, INPUTS>(derivatives + static_cast<size_t>(output) * ROW,
                                                  input + static_cast<size_t>(first) * ROW, samples, sums);
                    for (int o = 0; o < OUTPUTS; o++)
                        for (int i = 0; i < INPUTS; i++)
                            gradient[static_cast<size_t>(output + o) * inputs + first + i] +=
                                sums[o * INPUTS + i];
                });
            }
        });
    }
}

// Adds the sum over the samples of each row of derivatives.
inline void add_bias_gradient(const float* derivatives, int outputs, int samples, float* gradient) {
    for (int o = 0; o < outputs; o++) {
        Vector sum = {};
        for (int s = 0; s < samples; s += VECTOR_LENGTH)
            sum += load(derivatives + static_cast<size_t>(o) * ROW + s);
        gradient[o] += sum_of(sum);
    }
}

}  // namespace nisp
