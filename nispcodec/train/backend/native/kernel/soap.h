// SOAP: Adam in the eigenbasis of Shampoo's preconditioner, for one matrix. As soap.py for torch has
// it, and there is the source.
#pragma once

#include "optimizer_matrix.h"
#include "products.h"
#include "settings.h"

namespace nisp {

// One side of the matrix: its covariance, and a basis in which that is about diagonal.
struct Side {
    Matrix covariance, basis, basis_transposed;
    // Everything that a refresh needs is here from the start: it runs in a thread of the pool, where
    // nobody could be told that there is no memory.
    Matrix next, reflectors;
    Buffer eigenvalues, strengths;
    std::vector<int> order;  // of the basis before the last refresh

    explicit Side(int size)
        : covariance(size, size),
          basis(size, size),
          basis_transposed(size, size),
          next(size, size),
          reflectors(size, size),
          eigenvalues(size),
          strengths(size),
          order(size) {}

    // covariance += share * (matrix transposed - covariance)
    void remember(const Matrix& matrix, const Matrix& transposed, float share) {
        product(matrix, transposed, [&](int row, int column, Vector sum) {
            float* held = covariance.row(row) + column;
            store(held, load(held) + all(share) * (sum - load(held)));
        });
    }

    // One power iteration towards the eigenbasis, the largest eigenvalue first.
    void refresh() {
        // The rows of these two are the columns of basis and covariance x basis.
        store_product(basis_transposed, covariance, next);
        sort();
        for (int i = 0; i < basis.rows; i++)
            std::copy_n(next.row(order[i]), next.stride, basis_transposed.row(i));
        orthonormalize(basis_transposed, reflectors, strengths);
        transpose(basis_transposed, basis);
    }

   private:
    // Insertion: few numbers, almost in order, and it stands numbers that are none.
    void sort() {
        for (size_t i = 0; i < order.size(); i++) {
            const int row = static_cast<int>(i);
            eigenvalues[i] = dot(basis_transposed.row(row), next.row(row), 0, next.stride);
            size_t place = i;
            for (; place > 0 && eigenvalues[order[place - 1]] < eigenvalues[i]; place--)
                order[place] = order[place - 1];
            order[place] = row;
        }
    }
};

class Soap {
   public:
    Soap(OptimizerMatrix matrix, float rate)
        : matrix_(std::move(matrix)),
          rate_(rate),
          left_(matrix_.rows),
          right_(matrix_.columns),
          gradient_(matrix_.rows, matrix_.columns),
          transposed_(matrix_.columns, matrix_.rows),
          mean_(matrix_.rows, matrix_.columns),
          square_(matrix_.rows, matrix_.columns),
          half_rotated_(matrix_.rows, matrix_.columns),
          rotated_(matrix_.rows, matrix_.columns) {}

    int rows() const { return matrix_.rows; }
    int columns() const { return matrix_.columns; }
    // The gradient that the last step saw, (rows, columns) without padding.
    void write_gradient(float* to) const { gradient_.write(to); }

    void restart() { begun_ = false; }

    // The step after the first: everything begins with the first step's gradient, and orthonormal
    // bases (rows, rows) and (columns, columns), in which its covariances are diagonal.
    void begin(const float* left_basis, const float* right_basis) {
        begun_ = true;
        steps_ = 0;
        mean_.clear();
        square_.clear();
        take_basis(left_, left_basis);
        take_basis(right_, right_basis);
        remember(1.0f);
    }

    // The first step only measures, until `begin`.
    void step(float* weights, const float* gradient, double rate, const Settings& settings) {
        matrix_.gather(gradient, gradient_);
        if (!begun_) return;
        steps_++;
        const float share = static_cast<float>(1 - settings.soap_beta);
        rotate(left_.basis_transposed, gradient_, right_.basis);
        update_moments(share);
        remember(share);
        rotate(left_.basis_transposed, mean_, right_.basis);
        divide_by_root(settings);
        std::swap(rotated_.numbers, gradient_.numbers);
        rotate(left_.basis, gradient_, right_.basis_transposed);
        matrix_.subtract(weights, static_cast<float>(rate * rate_), rotated_);
        if (steps_ % settings.soap_refresh_every == 0) refresh();
    }

   private:
    OptimizerMatrix matrix_;
    float rate_;
    bool begun_ = false;
    long steps_ = 0;
    Side left_, right_;
    Matrix gradient_, transposed_, mean_, square_, half_rotated_, rotated_;

    static void take_basis(Side& side, const float* basis) {
        side.covariance.clear();
        side.basis.read(basis);
        transpose(side.basis, side.basis_transposed);
    }

    void remember(float share) {
        transpose(gradient_, transposed_);
        left_.remember(gradient_, transposed_, share);
        right_.remember(transposed_, gradient_, share);
    }

    // Into rotated_: left matrix right.
    void rotate(const Matrix& left, const Matrix& matrix, const Matrix& right) {
        store_product(left, matrix, half_rotated_);
        store_product(half_rotated_, right, rotated_);
    }

    // The mean is not rotated, as the bases change; the mean square is.
    void update_moments(float share) {
        each_vector(mean_, [&](size_t place) {
            float *mean = &mean_.numbers[place], *square = &square_.numbers[place];
            const Vector now = load(&rotated_.numbers[place]);
            store(mean, load(mean) + all(share) * (load(&gradient_.numbers[place]) - load(mean)));
            store(square, load(square) + all(share) * (now * now - load(square)));
        });
    }

    // Adam's step: the moments at their full size, as if they had begun long ago.
    void divide_by_root(const Settings& settings) {
        const float full = static_cast<float>(1 - std::pow(settings.soap_beta, steps_));
        const float epsilon = static_cast<float>(settings.soap_epsilon);
        const size_t count = rotated_.numbers.count();
        float* rotated = rotated_.numbers.data();
        const float* square = square_.numbers.data();
        for (size_t place = 0; place < count; place++)
            rotated[place] = (rotated[place] / full) / (std::sqrt(square[place] / full) + epsilon);
    }

    void refresh() {
        left_.refresh();
        right_.refresh();
        for (int i = 0; i < rows(); i++)
            for (int j = 0; j < columns(); j++)
                rotated_.row(i)[j] = square_.row(left_.order[i])[right_.order[j]];
        std::swap(rotated_.numbers, square_.numbers);
    }
};

}  // namespace nisp
