#pragma once

#include <hwy/highway.h>

#include "nuvo/render/fast.h"

// Run-time choice among the copies of a kernel that foreach_target.h compiled. A kernel's .cpp ends
// with HWY_ONCE code in which NUVO_FOR_ISA(isa, function) is the function of that instruction set.
// Plain SSE2 is Highway's portable target, compiled for the x86-64 baseline.

namespace nuvo {

/// kBest turned into the best that this machine has. Throws std::invalid_argument where the machine
/// lacks `isa`.
InstructionSet resolved(InstructionSet isa);

}  // namespace nuvo

// The copies that the compiler's flags let be made: -march=native leaves out what it supersedes.
#if HWY_TARGETS & HWY_AVX3
#define NUVO_IF_AVX512(isa, function) (isa) == ::nuvo::InstructionSet::kAvx512 ? &N_AVX3::function:
#else
#define NUVO_IF_AVX512(isa, function)
#endif
#if HWY_TARGETS & HWY_AVX2
#define NUVO_IF_AVX2(isa, function) (isa) == ::nuvo::InstructionSet::kAvx2 ? &N_AVX2::function:
#else
#define NUVO_IF_AVX2(isa, function)
#endif
#if HWY_TARGETS & HWY_SSE4
#define NUVO_IF_SSE4(isa, function) (isa) == ::nuvo::InstructionSet::kSse4 ? &N_SSE4::function:
#else
#define NUVO_IF_SSE4(isa, function)
#endif
// One copy alone needs no choice, and so no `isa`.
#define NUVO_FOR_ISA(isa, function)                                                    \
    (static_cast<void>(isa), NUVO_IF_AVX512(isa, function) NUVO_IF_AVX2(isa, function) \
                                     NUVO_IF_SSE4(isa, function) &                     \
                                 HWY_NAMESPACE::function)
