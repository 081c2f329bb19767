// The tuned numbers, all of them from nispcodec.train.config.
#pragma once

#include <cstdint>

namespace nisp {

// As the Python side fills it (`library.py`, Numbers). Change both together, and the version.
struct Settings {
    float near_distance, sign_weight, sign_softness;  // LossConfig
    float w0, last_layer_rate, ema_weight, clip;
    double muon_size, muon_least, muon_most, momentum_share;  // MuonConfig; double, as in Python
    float muon_quintic[3];
    int32_t muon_rounds;
    double soap_beta, soap_epsilon;  // SoapConfig
    int32_t soap_refresh_every;
};

// Added to norms that are divided by.
constexpr double TINY = 1e-12;

}  // namespace nisp
