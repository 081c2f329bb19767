// What Python calls (`mesh_kernel.py`). It has made the tree, and checked every size.
//
// Nothing here takes memory but the stack, so nothing throws.

#define EXPORTED extern "C" __attribute__((visibility("default")))

#include "closest.h"
#include "winding.h"

// To be raised with every change of what is below, or of a struct.
EXPORTED int32_t nisp_version() { return 1; }

// The best instruction set of this processor: x86-64-v2, -v3, -v4; 0 where there is nothing to say.
EXPORTED int32_t nisp_best_level() {
#if defined(__x86_64__)
    __builtin_cpu_init();
    if (!__builtin_cpu_supports("sse4.2") || !__builtin_cpu_supports("popcnt")) return 0;
    if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma") || !__builtin_cpu_supports("bmi2"))
        return 2;
    for (bool there : {__builtin_cpu_supports("avx512f") != 0, __builtin_cpu_supports("avx512bw") != 0,
                       __builtin_cpu_supports("avx512cd") != 0, __builtin_cpu_supports("avx512dq") != 0,
                       __builtin_cpu_supports("avx512vl") != 0})
        if (!there) return 3;
    return 4;
#else
    return 0;
#endif
}

// Of points (count, 3) the closest face and the squared distance from it.
EXPORTED void nisp_closest(const nisp::Tree* tree, const double* points, int64_t count, int32_t* faces,
                           double* squared) {
    for (int64_t i = 0; i < count; i++) {
        const nisp::Found found = nisp::ClosestTriangle(*tree, points + 3 * i).search();
        faces[i] = found.face;
        squared[i] = found.squared;
    }
}

// Of points (count, 3) whether they are inside, 1 or 0: by clusters from `rough` of their radii away,
// or from `exact` where the winding number is not `margin` away from 1/2.
EXPORTED void nisp_inside(const nisp::Tree* tree, const double* points, int64_t count, double rough,
                          double margin, double exact, uint8_t* inside) {
    for (int64_t i = 0; i < count; i++) {
        nisp::Winding winding(*tree, points + 3 * i);
        const double number = std::fabs(winding.about(rough));
        const bool clear = std::fabs(number - 0.5) >= margin;
        inside[i] = (clear ? number : std::fabs(winding.about(exact))) > 0.5;
    }
}

// Of points (count, 3) the winding number, each cluster as one from `radii` of its radii away.
EXPORTED void nisp_winding(const nisp::Tree* tree, const double* points, int64_t count, double radii,
                           double* numbers) {
    for (int64_t i = 0; i < count; i++) numbers[i] = nisp::Winding(*tree, points + 3 * i).about(radii);
}
