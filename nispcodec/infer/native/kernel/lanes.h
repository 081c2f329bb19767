// Eight numbers at a time, by the compiler's vectors: one, two or four of the processor's own.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

namespace nisp {

constexpr int LANES = 8;
// Bytes of a vector of the processor; of floats one of eight is enough.
constexpr int BYTES = 4 * NISP_VECTOR_LENGTH, FLOAT_BYTES = BYTES < 4 * LANES ? BYTES : 4 * LANES;
constexpr int DOUBLES = BYTES / 8, FLOATS = FLOAT_BYTES / 4;

typedef double Doubles __attribute__((vector_size(BYTES)));
typedef float Floats __attribute__((vector_size(FLOAT_BYTES)));
typedef double WideDoubles __attribute__((vector_size(8 * FLOATS)));

// From memory that need not be aligned.
template <class Vector, class Number>
inline Vector load(const Number* numbers) {
    Vector loaded;
    std::memcpy(&loaded, numbers, sizeof loaded);
    return loaded;
}

template <class Vector, class Number>
inline void store(Number* numbers, Vector vector) {
    std::memcpy(numbers, &vector, sizeof vector);
}

inline Floats rounded(WideDoubles values) { return __builtin_convertvector(values, Floats); }

template <class Vector>
inline Vector least(Vector a, Vector b) {
    return a < b ? a : b;
}
template <class Vector>
inline Vector greatest(Vector a, Vector b) {
    return a > b ? a : b;
}

inline Floats square_root(Floats values) {
    for (int lane = 0; lane < FLOATS; lane++) values[lane] = std::sqrt(values[lane]);
    return values;
}

inline float sum(Floats values) {
    float total = 0;
    for (int lane = 0; lane < FLOATS; lane++) total += values[lane];
    return total;
}

// A vector of three dimensions in each lane.
template <class Vector>
struct Three {
    Vector x, y, z;

    Three operator+(const Three& other) const { return {x + other.x, y + other.y, z + other.z}; }
    Three operator-(const Three& other) const { return {x - other.x, y - other.y, z - other.z}; }
    template <class Factor>
    Three operator*(const Factor& factor) const {
        return {x * factor, y * factor, z * factor};
    }
    Vector dot(const Three& other) const { return x * other.x + y * other.y + z * other.z; }
};

// Three rows of numbers, one after the other.
template <class Vector, class Number>
inline Three<Vector> load_three(const Number* rows) {
    return {load<Vector>(rows), load<Vector>(rows + LANES), load<Vector>(rows + 2 * LANES)};
}

}  // namespace nisp
