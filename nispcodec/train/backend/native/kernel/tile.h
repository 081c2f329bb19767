// Some samples on their way through the network and back. Everything is in rows: one number of
// each sample.
#pragma once

#include "layers.h"
#include "network.h"

namespace nisp {

// Pointers to what Python holds.
struct Samples {
    const float* points;    // (n, 3), not mirrored
    const float* sdf;       // (n,)
    const int32_t* chart;   // (n,)
    const float* uv;        // (n, 2)
};

class Tile {
   public:
    int count = 0;    // samples
    int samples = 0;  // what `count` is filled up to: points at 0 of chart 0 that count nothing

    explicit Tile(const Network& network)
        : network_(network),
          tables_(rows(network.table_columns())),
          table_derivatives_(rows(network.table_columns())),
          outputs_(rows(network.outputs)),
          charts_(TILE) {
        for (const Layer& layer : network.layers) activations_.push_back(rows(layer.inputs));
        for (int i = 0; i < network.hidden_layers(); i++) slopes_.push_back(rows(network.layers[i].outputs));
    }

    float* outputs() { return outputs_.data(); }
    const int32_t* charts() const { return charts_.data(); }
    const float* activations(int layer) const { return activations_[layer].data(); }
    const float* table_derivatives() const { return table_derivatives_.data(); }
    // The loss' derivatives by what a layer says before its activation; those of the last by the
    // outputs. Valid after `backward`.
    const float* derivatives(int layer) const {
        return layer < network_.hidden_layers() ? slopes_[layer].data() : outputs_.data();
    }

    // Begins a tile of `size` samples.
    void begin(int size) {
        count = size;
        samples = rounded_up(size, SAMPLES_AT_A_TIME);
        float* coordinates = activations_[0].data();
        for (int k = 0; k < network_.coordinates; k++)
            std::fill(coordinates + k * ROW + count, coordinates + k * ROW + samples, 0.0f);
        std::fill(charts_.begin() + count, charts_.begin() + samples, 0);
    }

    // Sample `s`: `point` is not mirrored yet.
    void place(int s, const float* point, int32_t chart) {
        float* coordinates = activations_[0].data() + s;
        for (int axis = 0; axis < 3; axis++)
            coordinates[axis * ROW] = network_.mirror >> axis & 1 ? std::fabs(point[axis]) : point[axis];
        for (int axis = 0, k = 3; axis < 3; axis++)
            if (network_.mirror >> (3 + axis) & 1) coordinates[k++ * ROW] = point[axis];
        charts_[s] = chart;
    }

    // Leaves every layer's input, and the slope of its sine, for the way back.
    void forward(const float* weights) {
        look_up(weights);
        const int last = network_.hidden_layers();
        for (int i = 0; i < last; i++) sine_layer(weights, i);
        const Layer& layer = network_.layers[last];
        float* outputs = outputs_.data();
        dense(as_weights(weights, layer), weights + layer.bias, layer.outputs, layer.inputs,
              activations_[last].data(), samples,
              [=](size_t place, Vector sum) { store(outputs + place, sum); });
        if (network_.affine) add_affine();
    }

    // From the loss' derivatives by the outputs, which are in their place, to those by everything.
    void backward(const float* weights) {
        for (int i = network_.hidden_layers(); i > 0; i--) {
            float* slopes = slopes_[i - 1].data();
            into_inputs(weights, i, 0, [=](size_t place, Vector sum) {
                store(slopes + place, load(slopes + place) * sum);
            });
        }
        if (network_.embedding > 0) {
            float* embedding = table_derivatives_.data();
            into_inputs(weights, 0, network_.coordinates,
                        [=](size_t place, Vector sum) { store(embedding + place, sum); });
        }
        if (network_.affine) affine_backward();
    }

    // Adds what this tile's samples say, after `backward`.
    void add_gradient(float* gradient) const {
        for (int i = 0; i <= network_.hidden_layers(); i++) {
            const Layer& layer = network_.layers[i];
            add_weight_gradient(derivatives(i), layer.outputs, activations(i), layer.inputs, samples,
                                gradient + layer.weight);
            add_bias_gradient(derivatives(i), layer.outputs, samples, gradient + layer.bias);
        }
        for (int column = 0; column < network_.table_columns(); column++) {
            const float* row = table_derivatives() + column * ROW;
            for (int s = 0; s < count; s++) gradient[network_.table_place(charts_[s], column)] += row[s];
        }
    }

   private:
    const Network& network_;
    std::vector<Buffer> activations_;  // of each layer, what enters it
    std::vector<Buffer> slopes_;       // of each sine; after the way back, derivatives
    Buffer tables_, table_derivatives_, outputs_;
    std::vector<int32_t> charts_;

    static Buffer rows(int count) { return Buffer(static_cast<size_t>(count) * ROW); }

    static Weights as_weights(const float* weights, const Layer& layer) {
        return {weights + layer.weight, static_cast<size_t>(layer.inputs), 1};
    }

    // Each sample's row of the tables; embeddings enter the first layer.
    void look_up(const float* weights) {
        for (int column = 0; column < network_.table_columns(); column++) {
            const bool enters = column < network_.embedding;
            float* row = enters ? activations_[0].data() + (network_.coordinates + column) * ROW
                                : tables_.data() + column * ROW;
            for (int s = 0; s < samples; s++) row[s] = weights[network_.table_place(charts_[s], column)];
        }
    }

    void sine_layer(const float* weights, int i) {
        const Layer& layer = network_.layers[i];
        float *sines = activations_[i + 1].data(), *cosines = slopes_[i].data();
        dense(as_weights(weights, layer), weights + layer.bias, layer.outputs, layer.inputs,
              activations_[i].data(), samples, [=](size_t place, Vector sum) {
                  Vector sine, cosine;
                  sine_and_cosine(sum, sine, cosine);
                  store(sines + place, sine);
                  store(cosines + place, cosine);
              });
    }

    // The derivatives by a layer's inputs, without the `first` ones.
    template <class Finish>
    void into_inputs(const float* weights, int i, int first, Finish finish) {
        const Layer& layer = network_.layers[i];
        const Weights transposed{weights + layer.weight + first, 1, static_cast<size_t>(layer.inputs)};
        dense(transposed, nullptr, layer.inputs - first, layer.outputs, derivatives(i), samples, finish);
    }

    // Rows of the tables, or of derivatives by them.
    float* slope_row(Buffer& tables, int output, int coordinate) {
        const int column = network_.embedding + output * network_.coordinates + coordinate;
        return tables.data() + column * ROW;
    }
    float* offset_row(Buffer& tables, int output) {
        return tables.data() + (network_.embedding + network_.slope_columns + output) * ROW;
    }

    void add_affine() {
        for (int o = 0; o < network_.outputs; o++) {
            float* output = outputs_.data() + o * ROW;
            const float* offset = offset_row(tables_, o);
            for (int s = 0; s < samples; s++) output[s] += offset[s];
            for (int k = 0; k < network_.coordinates; k++) {
                const float *slope = slope_row(tables_, o, k), *coordinate = activations(0) + k * ROW;
                for (int s = 0; s < samples; s++) output[s] += slope[s] * coordinate[s];
            }
        }
    }

    void affine_backward() {
        for (int o = 0; o < network_.outputs; o++) {
            const float* derivative = outputs_.data() + o * ROW;
            std::copy_n(derivative, samples, offset_row(table_derivatives_, o));
            for (int k = 0; k < network_.coordinates; k++) {
                float* by_slope = slope_row(table_derivatives_, o, k);
                const float* coordinate = activations(0) + k * ROW;
                for (int s = 0; s < samples; s++) by_slope[s] = derivative[s] * coordinate[s];
            }
        }
    }
};

}  // namespace nisp
