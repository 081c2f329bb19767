// Products of small matrices, and orthonormal bases.
#pragma once

#include <cmath>

#include "memory.h"

namespace nisp {

constexpr int PRODUCT_ROWS = MANY_REGISTERS ? 5 : 4;
constexpr int PRODUCT_VECTORS = MANY_REGISTERS ? 5 : 3;

// ROWS rows and VECTORS vectors of a b, beginning at (row, column): all sums stay in registers.
template <int ROWS, int VECTORS, class Finish>
inline void product_block(const Matrix& a, const Matrix& b, int row, int column, Finish& finish) {
    Vector sums[ROWS][VECTORS] = {};
    const float* left = a.row(row);
    const float* right = b.row(0) + column;
    for (int k = 0; k < a.columns; k++, right += b.stride) {
        Vector across[VECTORS];
        for (int v = 0; v < VECTORS; v++) across[v] = load(right + v * VECTOR_LENGTH);
        for (int r = 0; r < ROWS; r++) {
            const Vector down = all(left[static_cast<size_t>(r) * a.stride + k]);
            for (int v = 0; v < VECTORS; v++) sums[r][v] += down * across[v];
        }
    }
    for (int r = 0; r < ROWS; r++)
        for (int v = 0; v < VECTORS; v++) finish(row + r, column + v * VECTOR_LENGTH, sums[r][v]);
}

// The matrix product a b, handed over as finish(row, first column, vector): so it can be stored,
// added, or mixed with what is there, without another pass. The columns of a are the rows of b.
template <class Finish>
inline void product(const Matrix& a, const Matrix& b, Finish finish) {
    // Blocks as equal as may be: a block of one row or vector would wait for its own sums.
    const int down = (a.rows + PRODUCT_ROWS - 1) / PRODUCT_ROWS;
    const int across = (b.vectors() + PRODUCT_VECTORS - 1) / PRODUCT_VECTORS;
    for (int j = 0; j < across; j++) {
        const int vector = b.vectors() * j / across, vectors = b.vectors() * (j + 1) / across - vector;
        with_constant<PRODUCT_VECTORS>(vectors, [&](auto VECTORS) {
            for (int i = 0; i < down; i++) {
                const int row = a.rows * i / down, rows = a.rows * (i + 1) / down - row;
                with_constant<PRODUCT_ROWS>(rows, [&](auto ROWS) {
                    product_block<ROWS, VECTORS>(a, b, row, vector * VECTOR_LENGTH, finish);
                });
            }
        });
    }
}

// The same where a b is symmetric, but only from the vector that holds the diagonal on.
template <class Finish>
inline void upper_product(const Matrix& a, const Matrix& b, Finish finish) {
    const int down = (a.rows + PRODUCT_ROWS - 1) / PRODUCT_ROWS;
    for (int i = 0; i < down; i++) {
        const int row = a.rows * i / down, rows = a.rows * (i + 1) / down - row;
        with_constant<PRODUCT_ROWS>(rows, [&](auto ROWS) {
            int vector = row / VECTOR_LENGTH;
            while (vector < b.vectors()) {
                const int vectors = std::min(PRODUCT_VECTORS, b.vectors() - vector);
                with_constant<PRODUCT_VECTORS>(vectors, [&](auto VECTORS) {
                    product_block<ROWS, VECTORS>(a, b, row, vector * VECTOR_LENGTH, finish);
                });
                vector += vectors;
            }
        });
    }
}

// Copies what is above the diagonal to below.
inline void mirror(Matrix& matrix) {
    for (int i = 0; i < matrix.rows; i++) {
        const float* from = matrix.row(i);
        float* to = matrix.numbers.data() + i;
        for (int j = i + 1; j < matrix.rows; j++) to[static_cast<size_t>(j) * matrix.stride] = from[j];
    }
}

inline void store_product(const Matrix& a, const Matrix& b, Matrix& to) {
    product(a, b, [&](int row, int column, Vector sum) { store(to.row(row) + column, sum); });
}

inline float dot(const float* a, const float* b, int begin, int end) {
    Vector sum = {};
    for (int k = begin; k < end; k += VECTOR_LENGTH) sum += load(a + k) * load(b + k);
    return sum_of(sum);
}

inline void add_multiple(float* to, float factor, const float* from, int begin, int end) {
    const Vector factors = all(factor);
    for (int k = begin; k < end; k += VECTOR_LENGTH) store(to + k, load(to + k) + factors * load(from + k));
}

// The reflection 1 - strength v v^T that brings a row's entries from `first` on to its first one,
// v in `reflector`; returns the strength, 0 where there is nothing to bring.
inline float reflection(const float* row, int first, int columns, int stride, float* reflector) {
    std::fill_n(reflector, stride, 0.0f);
    std::copy(row + first, row + columns, reflector + first);
    const int begin = first / VECTOR_LENGTH * VECTOR_LENGTH;
    const float norm = std::sqrt(dot(reflector, reflector, begin, stride)), head = row[first];
    // The sign that does not cancel.
    const float target = head > 0 ? -norm : norm;
    if (first + 1 >= columns || norm == 0) return 0.0f;
    for (int k = first + 1; k < columns; k++) reflector[k] /= head - target;
    reflector[first] = 1.0f;
    return (target - head) / target;
}

inline void reflect(float* row, const float* reflector, float strength, int first, int stride) {
    const int begin = first / VECTOR_LENGTH * VECTOR_LENGTH;
    add_multiple(row, -strength * dot(reflector, row, begin, stride), reflector, begin, stride);
}

// Makes the rows of a square matrix orthonormal by Householder's reflections, first to last, as the
// Q of a QR decomposition whose columns these rows are. `reflectors` is of the same size, `strengths`
// has a number for each row.
inline void orthonormalize(Matrix& rows, Matrix& reflectors, Buffer& strengths) {
    const int count = rows.rows, stride = rows.stride;
    for (int k = 0; k < count; k++) {
        float* reflector = reflectors.row(k);
        const float strength = strengths[k] = reflection(rows.row(k), k, count, stride, reflector);
        if (strength == 0) continue;
        for (int j = k + 1; j < count; j++) reflect(rows.row(j), reflector, strength, k, stride);
    }
    rows.clear();
    for (int k = 0; k < count; k++) rows.row(k)[k] = 1.0f;
    for (int k = count - 1; k >= 0; k--) {
        if (strengths[k] == 0) continue;
        for (int j = k; j < count; j++) reflect(rows.row(j), reflectors.row(k), strengths[k], k, stride);
    }
}

}  // namespace nisp
