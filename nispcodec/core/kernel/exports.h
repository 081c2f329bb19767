// What every library has that `nispcodec.core.compiled` loads, besides `nisp_version`. Included once.

#pragma once

#include <cstdint>
#include <initializer_list>

#define EXPORTED extern "C" __attribute__((visibility("default")))

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
