// The losses of nispcodec.train.objectives: each puts the derivative in the place of the outputs
// and returns its share of the batch' loss.
#pragma once

#include "settings.h"
#include "tile.h"

namespace nisp {

// What the samples of a tile are to be.
struct Targets {
    Buffer sdf{TILE}, uv{2 * ROW};
    Buffer share{TILE};  // of each sample in the batch' mean; 0 for what fills up the tile

    void begin(const Tile& tile, int batch) {
        std::fill_n(share.data(), tile.count, 1.0f / batch);
        std::fill(share.data() + tile.count, share.data() + tile.samples, 0.0f);
        std::fill(sdf.data() + tile.count, sdf.data() + tile.samples, 1.0f);
    }
};

// sigmoid(x), and log(1 + e^x) behind it, from the one exponential that does not overflow.
inline Vector sigmoid_and_softplus(Vector x, Vector& softplus) {
    const Vector one = all(1.0f), small = exponential(-absolute(x));
    softplus = larger(x, all(0.0f)) + logarithm(one + small);
    return select(x > all(0.0f), one, small) / (one + small);
}

// Mean of (|f - sdf| + the logistic loss of the sign) / (|sdf| + near).
inline float sdf_loss(Tile& tile, const Targets& targets, const Settings& settings) {
    const Vector softness = all(settings.sign_softness), weight = all(settings.sign_weight);
    float* field = tile.outputs();
    Vector loss = {};
    for (int s = 0; s < tile.samples; s += VECTOR_LENGTH) {
        const Vector sdf = load(targets.sdf.data() + s), error = load(field + s) - sdf;
        const Vector share =
            load(targets.share.data() + s) / (absolute(sdf) + all(settings.near_distance));
        Vector softplus;
        const Vector wrong = sigmoid_and_softplus(-load(field + s) * sign(sdf) / softness, softplus);
        loss += (absolute(error) + weight * softness * softplus) * share;
        store(field + s, (sign(error) - weight * sign(sdf) * wrong) * share);
    }
    return sum_of(loss);
}

// Cross-entropy for one vector of samples, whose logits are `outputs` rows from `logits` on.
inline Vector cross_entropy(float* logits, int outputs, const int32_t* charts, Vector share) {
    Vector largest = load(logits);
    for (int k = 1; k < outputs; k++) largest = larger(largest, load(logits + k * ROW));
    Vector wanted, sum = {};
    for (int s = 0; s < VECTOR_LENGTH; s++) wanted[s] = logits[static_cast<size_t>(charts[s]) * ROW + s];
    for (int k = 0; k < outputs; k++) {
        const Vector power = exponential(load(logits + k * ROW) - largest);
        store(logits + k * ROW, power);
        sum += power;
    }
    for (int k = 0; k < outputs; k++) store(logits + k * ROW, load(logits + k * ROW) * (share / sum));
    for (int s = 0; s < VECTOR_LENGTH; s++) logits[static_cast<size_t>(charts[s]) * ROW + s] -= share[s];
    return (largest + logarithm(sum) - wanted) * share;
}

inline float chart_loss(Tile& tile, const Targets& targets, const Network& network) {
    Vector loss = {};
    for (int s = 0; s < tile.samples; s += VECTOR_LENGTH)
        loss += cross_entropy(tile.outputs() + s, network.outputs, tile.charts() + s,
                              load(targets.share.data() + s));
    return sum_of(loss);
}

// Mean absolute error of u and v.
inline float uv_loss(Tile& tile, const Targets& targets) {
    Vector loss = {};
    for (int part = 0; part < 2; part++)
        for (int s = 0; s < tile.samples; s += VECTOR_LENGTH) {
            float* output = tile.outputs() + part * ROW + s;
            const Vector error = load(output) - load(targets.uv.data() + part * ROW + s);
            const Vector share = load(targets.share.data() + s) * all(0.5f);
            loss += absolute(error) * share;
            store(output, sign(error) * share);
        }
    return sum_of(loss);
}

}  // namespace nisp
