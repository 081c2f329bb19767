// Memory aligned to whole vectors and cache lines, and matrices in it.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <new>
#include <utility>

#include "vectors.h"

namespace nisp {

constexpr size_t CACHE_LINE = 64;

// `count` floats, 0 at first.
class Buffer {
   public:
    Buffer() = default;
    explicit Buffer(size_t count) : count_(count) {
        const size_t lines = (count * sizeof(float) + CACHE_LINE - 1) / CACHE_LINE;
        data_ = static_cast<float*>(std::aligned_alloc(CACHE_LINE, (lines + 1) * CACHE_LINE));
        if (data_ == nullptr) throw std::bad_alloc();
        clear();
    }
    Buffer(Buffer&& other) noexcept { swap(other); }
    Buffer& operator=(Buffer&& other) noexcept {
        swap(other);
        return *this;
    }
    ~Buffer() { std::free(data_); }

    void clear() {
        if (count_ > 0) std::memset(data_, 0, count_ * sizeof(float));
    }
    void swap(Buffer& other) noexcept {
        std::swap(data_, other.data_);
        std::swap(count_, other.count_);
    }
    float* data() { return data_; }
    const float* data() const { return data_; }
    size_t count() const { return count_; }
    float& operator[](size_t place) { return data_[place]; }
    float operator[](size_t place) const { return data_[place]; }

   private:
    float* data_ = nullptr;
    size_t count_ = 0;
};

// Row after row, each padded with zeros to whole vectors. Whoever writes a matrix keeps them zero.
struct Matrix {
    int rows = 0, columns = 0, stride = 0;
    Buffer numbers;

    Matrix() = default;
    Matrix(int rows, int columns)
        : rows(rows),
          columns(columns),
          stride(rounded_up(columns, VECTOR_LENGTH)),
          numbers(static_cast<size_t>(rows) * stride) {}

    float* row(int i) { return numbers.data() + static_cast<size_t>(i) * stride; }
    const float* row(int i) const { return numbers.data() + static_cast<size_t>(i) * stride; }
    int vectors() const { return stride / VECTOR_LENGTH; }
    void clear() { numbers.clear(); }

    // From and to rows without padding.
    void read(const float* plain) {
        for (int i = 0; i < rows; i++) std::copy_n(plain + static_cast<size_t>(i) * columns, columns, row(i));
    }
    void write(float* plain) const {
        for (int i = 0; i < rows; i++) std::copy_n(row(i), columns, plain + static_cast<size_t>(i) * columns);
    }
};

inline void transpose(const Matrix& from, Matrix& to) {
    for (int i = 0; i < from.rows; i++) {
        const float* row = from.row(i);
        for (int j = 0; j < from.columns; j++) to.row(j)[i] = row[j];
    }
}

// Calls body(place) for the first number of every vector of a matrix.
template <class Body>
inline void each_vector(const Matrix& matrix, Body body) {
    const size_t count = static_cast<size_t>(matrix.rows) * matrix.stride;
    for (size_t place = 0; place < count; place += VECTOR_LENGTH) body(place);
}

// Sum of the squares of `count` floats at any address. Four sums hide the latency of adding.
inline double square_sum(const float* numbers, size_t count) {
    constexpr int SUMS = 4;
    Vector sums[SUMS] = {};
    size_t done = 0;
    for (; done + SUMS * VECTOR_LENGTH <= count; done += SUMS * VECTOR_LENGTH)
        for (int k = 0; k < SUMS; k++) {
            Vector next;
            std::memcpy(&next, numbers + done + k * VECTOR_LENGTH, sizeof next);
            sums[k] += next * next;
        }
    double total = sum_of((sums[0] + sums[1]) + (sums[2] + sums[3]));
    for (; done < count; done++) total += static_cast<double>(numbers[done]) * numbers[done];
    return total;
}

}  // namespace nisp
