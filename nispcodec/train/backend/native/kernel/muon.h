// Muon: momentum, made orthogonal, for one matrix between two hidden layers. As muon.py for torch
// has it, and there is the source.
#pragma once

#include "optimizer_matrix.h"
#include "products.h"
#include "settings.h"

namespace nisp {

class Muon {
   public:
    // `longest_side` is that of all matrices that take such steps.
    Muon(OptimizerMatrix matrix, int longest_side)
        : matrix_(std::move(matrix)),
          longest_side_(longest_side),
          wide_(matrix_.rows <= matrix_.columns),
          gradient_(matrix_.rows, matrix_.columns),
          momentum_(matrix_.rows, matrix_.columns),
          found_(short_side(), long_side()),
          next_(short_side(), long_side()),
          found_transposed_(long_side(), short_side()),
          square_(short_side(), short_side()),
          factor_(short_side(), short_side()) {}

    void restart() {
        momentum_.clear();
        steps_ = 0;
    }

    void step(float* weights, const float* gradient, double rate, const Settings& settings) {
        steps_++;
        const double share = settings.momentum_share * steps_;
        const double held = std::min(std::max(share, settings.muon_least), settings.muon_most);
        const double size = settings.muon_size * std::sqrt(longest_side_ / held);
        matrix_.gather(gradient, gradient_);
        look_ahead(static_cast<float>(1 - 1 / held));
        orthogonalize(settings);
        matrix_.subtract(weights, static_cast<float>(size * rate * settings.w0), direction());
    }

   private:
    OptimizerMatrix matrix_;
    int longest_side_;
    bool wide_;
    long steps_ = 0;
    Matrix gradient_, momentum_;
    // The iteration takes the matrix so that its rows are the shorter side.
    Matrix found_, next_, found_transposed_, square_, factor_;

    int short_side() const { return std::min(matrix_.rows, matrix_.columns); }
    int long_side() const { return std::max(matrix_.rows, matrix_.columns); }

    // After the iteration the transpose is no longer needed, nor the gradient.
    const Matrix& direction() {
        if (wide_) return found_;
        transpose(found_, gradient_);
        return gradient_;
    }

    // Into found_: the gradient and the momentum as it will be (Nesterov).
    void look_ahead(float memory) {
        each_vector(gradient_, [&](size_t place) {
            const Vector gradient = load(&gradient_.numbers[place]);
            const Vector momentum = load(&momentum_.numbers[place]) * all(memory) + gradient;
            store(&momentum_.numbers[place], momentum);
            store(&gradient_.numbers[place], gradient + all(memory) * momentum);
        });
        if (wide_)
            std::copy_n(gradient_.numbers.data(), gradient_.numbers.count(), found_.numbers.data());
        else
            transpose(gradient_, found_);
    }

    // Newton and Schulz' iteration: singular values of found_ become 0.7 to 1.2.
    void orthogonalize(const Settings& settings) {
        const double norm = std::sqrt(square_sum(found_.numbers.data(), found_.numbers.count()));
        const Vector scale = all(static_cast<float>(1 / (norm + TINY)));
        each_vector(found_, [&](size_t place) {
            store(&found_.numbers[place], load(&found_.numbers[place]) * scale);
        });
        for (int round = 0; round < settings.muon_rounds; round++) iterate(settings.muon_quintic);
    }

    // X -> first X + third (X X^T) X + fifth (X X^T)^2 X
    void iterate(const float* quintic) {
        const Vector first = all(quintic[0]), third = all(quintic[1]), fifth = all(quintic[2]);
        transpose(found_, found_transposed_);
        upper_product(found_, found_transposed_, [&](int row, int column, Vector sum) {
            store(square_.row(row) + column, sum);
        });
        mirror(square_);
        upper_product(square_, square_, [&](int row, int column, Vector sum) {
            store(factor_.row(row) + column, third * load(square_.row(row) + column) + fifth * sum);
        });
        mirror(factor_);
        product(factor_, found_, [&](int row, int column, Vector sum) {
            store(next_.row(row) + column, first * load(found_.row(row) + column) + sum);
        });
        std::swap(found_.numbers, next_.numbers);
    }
};

}  // namespace nisp
