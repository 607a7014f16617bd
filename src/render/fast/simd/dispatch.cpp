#include "fast/simd/dispatch.h"

#include <algorithm>
#include <stdexcept>

namespace nuvo {

// What there are kernels for (a build for one machine has one set) and the compiler may use in
// Highway's targets of these names. Highway's own answer would be in its shared library, which
// measures the processor's clocks when it is loaded: 2 ms of every run.
std::vector<InstructionSet> supported_instruction_sets() {
    std::vector<InstructionSet> sets;
#if HWY_ARCH_X86
    const bool sse4 = __builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("aes") &&
                      __builtin_cpu_supports("pclmul");
    const bool avx2 = sse4 && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                      __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
    const bool avx512 = avx2 && __builtin_cpu_supports("avx512f") &&
                        __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq") &&
                        __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512cd");
    if (avx512 && (HWY_TARGETS & HWY_AVX3) != 0) sets.push_back(InstructionSet::kAvx512);
    if (avx2 && (HWY_TARGETS & HWY_AVX2) != 0) sets.push_back(InstructionSet::kAvx2);
    if (sse4 && (HWY_TARGETS & HWY_SSE4) != 0) sets.push_back(InstructionSet::kSse4);
#endif
    constexpr bool kIsPortable =
        (HWY_STATIC_TARGET & (HWY_AVX3 | HWY_AVX2 | HWY_SSE4 | HWY_SSSE3)) == 0;
    if (sets.empty() || kIsPortable) sets.push_back(InstructionSet::kSse2);
    return sets;
}

InstructionSet resolved(InstructionSet isa) {
    const std::vector<InstructionSet> sets = supported_instruction_sets();
    if (isa == InstructionSet::kBest) return sets.front();
    if (std::find(sets.begin(), sets.end(), isa) == sets.end())
        throw std::invalid_argument("this machine lacks the instruction set");
    return isa;
}

}  // namespace nuvo
