// Vectors of VECTOR_LENGTH floats, by the vector extensions that GCC and Clang share, and the
// elementary functions on them.
//
// The same source is compiled once for every instruction set. Nothing here may be compiled with
// -ffast-math: rounding by adding and subtracting a large number would be simplified away.
#pragma once

#include <cstdint>
#include <cstring>
#include <type_traits>

#ifndef NISP_VECTOR_LENGTH
#define NISP_VECTOR_LENGTH 4
#endif

namespace nisp {

constexpr int VECTOR_LENGTH = NISP_VECTOR_LENGTH;

typedef float Vector __attribute__((vector_size(VECTOR_LENGTH * 4), may_alias));
typedef int32_t Integers __attribute__((vector_size(VECTOR_LENGTH * 4), may_alias));

// How many vectors a loop may keep in registers decides its blocks: with 32 registers 24 or 25 sums
// and what they are made of, with 16 twelve.
#if defined(__AVX512F__) || defined(__aarch64__)
constexpr int MANY_REGISTERS = 1;
#else
constexpr int MANY_REGISTERS = 0;
#endif

constexpr int rounded_up(int count, int multiple) { return (count + multiple - 1) / multiple * multiple; }

inline Vector all(float value) { return value - Vector{}; }
inline Integers all_integers(int32_t value) { return value - Integers{}; }

// Addresses of `load` and `store` are multiples of a vector.
inline Vector load(const float* from) { return *reinterpret_cast<const Vector*>(from); }
inline void store(float* to, Vector value) { *reinterpret_cast<Vector*>(to) = value; }

inline Vector as_floats(Integers bits) { return reinterpret_cast<Vector&>(bits); }
inline Integers as_bits(Vector value) { return reinterpret_cast<Integers&>(value); }

inline Vector select(Integers condition, Vector yes, Vector no) {
    return as_floats((condition & as_bits(yes)) | (~condition & as_bits(no)));
}
inline Vector absolute(Vector x) { return as_floats(as_bits(x) & all_integers(0x7fffffff)); }
inline Vector larger(Vector a, Vector b) { return select(a > b, a, b); }

// -1, 0 or 1.
inline Vector sign(Vector x) {
    const Vector zero = all(0.0f);
    return select(x > zero, all(1.0f), select(x < zero, all(-1.0f), zero));
}

// Calls body(std::integral_constant<int, value>) for a value from 1 to MOST: loops over it unroll.
template <int MOST, class Body>
inline void with_constant(int value, Body body) {
    if constexpr (MOST > 1) {
        if (value < MOST) {
            with_constant<MOST - 1>(value, body);
            return;
        }
    }
    body(std::integral_constant<int, MOST>{});
}

// Sums of neighbors: those of `a`, then those of `b`.
inline Vector neighbor_sums(Vector a, Vector b) {
#if NISP_VECTOR_LENGTH == 16
#define NISP_EVEN 0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30
#define NISP_ODD 1, 3, 5, 7, 9, 11, 13, 15, 17, 19, 21, 23, 25, 27, 29, 31
#elif NISP_VECTOR_LENGTH == 8
#define NISP_EVEN 0, 2, 4, 6, 8, 10, 12, 14
#define NISP_ODD 1, 3, 5, 7, 9, 11, 13, 15
#else
#define NISP_EVEN 0, 2, 4, 6
#define NISP_ODD 1, 3, 5, 7
#endif
#if defined(__clang__)
    return __builtin_shufflevector(a, b, NISP_EVEN) + __builtin_shufflevector(a, b, NISP_ODD);
#else  // GCC before 12 has no other
    return __builtin_shuffle(a, b, Integers{NISP_EVEN}) + __builtin_shuffle(a, b, Integers{NISP_ODD});
#endif
}

// The sums of COUNT vectors, at most SPAN, side by side in the SPAN / COUNT-th part of a vector.
template <int SPAN, int COUNT>
inline Vector partial_sums(const Vector* vectors) {
    if constexpr (COUNT <= 0) {
        return all(0.0f);
    } else if constexpr (SPAN == 1) {
        return vectors[0];
    } else {
        constexpr int HALF = SPAN / 2, LEFT = COUNT < HALF ? COUNT : HALF;
        return neighbor_sums(partial_sums<HALF, LEFT>(vectors),
                             partial_sums<HALF, COUNT - LEFT>(vectors + HALF));
    }
}

// The sum of each of COUNT vectors. One tree for VECTOR_LENGTH of them takes a third of the
// instructions that as many single sums take.
template <int COUNT>
inline void sums_of(const Vector* vectors, float* sums) {
    constexpr int NOW = COUNT < VECTOR_LENGTH ? COUNT : VECTOR_LENGTH;
    const Vector found = partial_sums<VECTOR_LENGTH, NOW>(vectors);
    std::memcpy(sums, &found, NOW * sizeof(float));
    if constexpr (COUNT > NOW) sums_of<COUNT - NOW>(vectors + NOW, sums + NOW);
}

inline float sum_of(Vector vector) {
    float sum;
    sums_of<1>(&vector, &sum);
    return sum;
}

// Added and subtracted again it rounds a float to an integer, which then is in its last bits.
constexpr float ROUNDER = 12582912.0f;  // 1.5 * 2^23

// sin and cos to about 1e-7, for |x| up to some thousands. x is brought to [-pi/2, pi/2] by
// multiples of pi; pi is in three parts, the first two of few bits, so that their multiples are
// exact without fused operations as well.
inline void sine_and_cosine(Vector x, Vector& sine, Vector& cosine) {
    const Vector shifted = x * all(0.318309886f) + all(ROUNDER);
    const Vector turns = shifted - all(ROUNDER);
    Vector r = x - turns * all(3.140625f);
    r = r - turns * all(9.67025757e-4f);
    r = r - turns * all(6.27711415e-7f);
    const Vector u = r * r;
    Vector p = all(2.63476686e-6f);
    p = p * u + all(-1.98227440e-4f);
    p = p * u + all(8.33324215e-3f);
    p = p * u + all(-1.66666660e-1f);
    Vector q = all(2.34764379e-5f);
    q = q * u + all(-1.38686245e-3f);
    q = q * u + all(4.16656701e-2f);
    q = q * u + all(-4.99999923e-1f);
    // An odd number of half turns changes both signs.
    const Integers flip = as_bits(shifted) << 31;
    sine = as_floats(as_bits((p * u) * r + r) ^ flip);
    cosine = as_floats(as_bits(q * u + all(1.0f)) ^ flip);
}

// exp to about 1e-7 for x up to 88; what is below -87 counts as -87. 2^n times a polynomial of the
// rest, within half an octave.
inline Vector exponential(Vector x) {
    x = larger(x, all(-87.0f));
    const Vector shifted = x * all(1.44269504f) + all(ROUNDER);
    const Vector octaves = shifted - all(ROUNDER);
    // ln 2 in two parts, the first of few bits: its multiples are exact.
    Vector r = x - octaves * all(0.693359375f);
    r = r - octaves * all(-2.12194440e-4f);
    Vector p = all(1.38144668e-3f);
    p = p * r + all(8.36878042e-3f);
    p = p * r + all(4.16683942e-2f);
    p = p * r + all(1.66665201e-1f);
    p = p * r + all(4.99999934e-1f);
    p = p * (r * r) + r + all(1.0f);
    return as_floats(as_bits(p) + (as_bits(shifted) << 23));
}

// log to about 1e-7, for normal numbers above 0.
inline Vector logarithm(Vector x) {
    // x = 2^n m with m from sqrt(1/2) to sqrt(2).
    const Integers offset = as_bits(x) - all_integers(0x3f3504f3);
    const Integers octaves = offset >> 23;
    const Vector m = as_floats((offset & all_integers(0x007fffff)) + all_integers(0x3f3504f3));
    // log m = 2 atanh s = 2 (s + s^3 / 3 + ...).
    const Vector s = (m - all(1.0f)) / (m + all(1.0f));
    const Vector u = s * s;
    Vector p = all(2.0f / 9);
    p = p * u + all(2.0f / 7);
    p = p * u + all(2.0f / 5);
    p = p * u + all(2.0f / 3);
    const Vector n = __builtin_convertvector(octaves, Vector);
    return n * all(0.693147181f) + (s * all(2.0f) + (p * u) * s);
}

}  // namespace nisp
