#include "dispatch.h"

#include <hwy/targets.h>
#include <algorithm>
#include <stdexcept>

namespace nuvo {

std::vector<InstructionSet> supported_instruction_sets() {
    std::vector<InstructionSet> sets;
#if HWY_ARCH_X86
    // Asked once: the processor's answer is slow, above all on virtual machines.
    static const auto supported = hwy::SupportedTargets();
    const auto has = [](auto target) { return (supported & target) != 0; };
    if (has(HWY_AVX3)) sets.push_back(InstructionSet::kAvx512);
    if (has(HWY_AVX2)) sets.push_back(InstructionSet::kAvx2);
    if (has(HWY_SSE4)) sets.push_back(InstructionSet::kSse4);
#endif
    sets.push_back(InstructionSet::kSse2);
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
