#include "fast/light/wanted_items.h"

#include <bit>
#include <cstdint>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fast/light/wanted_items.cpp"
#include <hwy/foreach_target.h>

#include "fast/light/light_cells.h"
#include "fast/light/light_ranges.h"
#include "fast/simd/lanes.h"

// The octree is walked down; a voxel that lies deeper, wherever the light sees it, than all wanted
// points is left out with all that is in it. What is listed in the others is asked for by itself.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

class WantedRanges {
  public:
    WantedRanges(const LightItems& items, const WantedDepths& wanted)
        : wanted_(wanted), map_(wanted.map()) {
        LightMap map;
        float extent[2];
        ranges_.start(wanted.light(), items.scene, map, extent);
        // Points known less well are counted wherever they may be.
        ranges_.allow(kMostPointError * map.point_size, items.touch, map);
    }

    /// Which of `there` are wanted.
    HWY_INLINE std::uint32_t among(const ItemCorners& items, std::uint32_t there) {
        std::uint32_t found = 0;
        ranges_.for_each_face(
            items, there, [&](int face, const LightRanges& ranges, std::uint32_t lanes) HWY_ATTR {
                // Not so written that a NaN would leave it out.
                found |= lanes & ~(ranges.near > deepest(face, ranges)).bits();
            });
        return found;
    }

  private:
    // Bounds the depths of points within the ranges from above: by the four cells at their corners
    // on the level where a cell is no smaller than they are.
    HWY_INLINE Floats deepest(int face, const LightRanges& ranges) const {
        constexpr int kExponentOfHalf = 126;
        Ints low[2];
        Ints high[2];
        for (int i = 0; i < 2; ++i) {
            low[i] = integers_from(step_of(map_, i, ranges.low[i]));
            high[i] = integers_from(step_of(map_, i, ranges.high[i]));
        }
        const Ints span = max(high[0] - low[0], high[1] - low[1]);
        const Ints bit_width = shift_right<23>(bits_of(floats_from(span))) - Ints(kExponentOfHalf);
        const Ints level = max(bit_width - Ints(wanted_.step_bits()), Ints(0));
        const Ints shift = level + Ints(wanted_.step_bits());
        const Ints side = Ints(wanted_.cells_a_side()) >> level;
        const Ints start = Ints::gather(wanted_.level_starts(), level) + Ints(face) * side * side;
        const auto at = [&](const Ints& x, const Ints& y) HWY_ATTR {
            return Floats::gather(wanted_.cells(), start + (y >> shift) * side + (x >> shift));
        };
        return max(max(at(low[0], low[1]), at(high[0], low[1])),
                   max(at(low[0], high[1]), at(high[0], high[1])));
    }

    const WantedDepths& wanted_;
    const LightMap& map_;
    ItemRanges ranges_;
};

class WantedWalk {
  public:
    WantedWalk(const LightItems& items, const WantedDepths& wanted)
        : octree_(items.scene.octree()), ranges_(items, wanted) {}

    /// Sets the bits of the slots that are listed in wanted leaves of the node.
    void run(const WantedNode& from, std::uint64_t* marks) {
        WantedNode stack[CompactOctree::kMostWaiting];
        int waiting = 0;
        stack[waiting++] = from;
        while (waiting != 0) {
            const WantedNode at = stack[--waiting];
            const CompactNode& node = octree_.nodes[at.node];
            if (node.is_leaf()) {
                const std::uint32_t* const items = octree_.items.data() + node.first_item();
                for (std::uint32_t i = 0; i < node.item_count(); ++i)
                    marks[items[i] / 64] |= std::uint64_t{1} << items[i] % 64;
            } else {
                waiting += children(at, stack + waiting);
            }
        }
    }

    /// Puts the wanted children of an interior node to `out`; returns their number.
    int children(const WantedNode& at, WantedNode* out) {
        const CompactNode& node = octree_.nodes[at.node];
        ItemCorners boxes;
        boxes.count = 2;
        alignas(64) float face[2][3][16];
        for (int axis = 0; axis < 3; ++axis)
            for (unsigned octant = 0; octant < 16; ++octant) {
                const bool upper = (octant >> axis & 1) != 0;
                face[0][axis][octant] = upper ? node.cut[axis] : at.low[axis];
                face[1][axis][octant] = upper ? at.high[axis] : node.cut[axis];
            }
        for (int end = 0; end < 2; ++end)
            for (int axis = 0; axis < 3; ++axis)
                boxes.at[end][axis] = Floats::load(face[end][axis]);
        int count = 0;
        for (std::uint32_t found = ranges_.among(boxes, node.mask()); found != 0;
             found &= found - 1) {
            const auto octant = static_cast<unsigned>(std::countr_zero(found));
            WantedNode& child = out[count++];
            child.node = node.child(octant);
            for (int axis = 0; axis < 3; ++axis) {
                child.low[axis] = face[0][axis][octant];
                child.high[axis] = face[1][axis][octant];
            }
            __builtin_prefetch(&octree_.nodes[child.node]);
        }
        return count;
    }

  private:
    const CompactOctree& octree_;
    WantedRanges ranges_;
};

// Some nodes whose subtrees hold all wanted leaves: enough for many threads.
void divide_octree(const LightItems& items, const WantedDepths& wanted,
                   std::vector<WantedNode>& nodes) {
    constexpr std::size_t kMany = 256;
    const CompactOctree& octree = items.scene.octree();
    WantedWalk walk(items, wanted);
    WantedNode root{0, {}, {}};
    for (int axis = 0; axis < 3; ++axis) {
        root.low[axis] = octree.bounds.min[axis];
        root.high[axis] = octree.bounds.max[axis];
    }
    nodes = {root};
    for (std::size_t before = 0; before != nodes.size() && nodes.size() < kMany;) {
        before = nodes.size();
        std::vector<WantedNode> next;
        for (const WantedNode& at : nodes) {
            if (octree.nodes[at.node].is_leaf()) {
                next.push_back(at);
                continue;
            }
            WantedNode children[8];
            const int count = walk.children(at, children);
            next.insert(next.end(), children, children + count);
        }
        nodes = std::move(next);
    }
}

void mark_wanted(const LightItems& items, const WantedDepths& wanted, const WantedNode& node,
                 std::uint64_t* marks) {
    WantedWalk(items, wanted).run(node, marks);
}

// Appends the marked slots of 64 `words` from `first` on that are wanted themselves.
void choose_wanted(const LightItems& items, const WantedDepths& wanted,
                   std::span<const std::uint64_t> words, Slot first, std::vector<Slot>& out) {
    WantedRanges ranges(items, wanted);
    const Slot triangle_end = items.scene.triangle_end();
    // Those of the second half are on their way from memory while the first is asked about.
    Slot waiting[32];
    Slot count = 0;
    const auto ask = [&]() HWY_ATTR {
        const Slot some = std::min<Slot>(16, count);
        const ItemCorners corners = corners_of(items, some, [&](Slot i) { return waiting[i]; });
        for (std::uint32_t found = ranges.among(corners, (1U << some) - 1); found != 0;
             found &= found - 1)
            out.push_back(waiting[std::countr_zero(found)]);
        std::copy(waiting + some, waiting + count, waiting);
        count -= some;
    };
    for (const std::uint64_t word : words) {
        for (std::uint64_t bits = word; bits != 0; bits &= bits - 1) {
            const Slot slot = first + static_cast<Slot>(std::countr_zero(bits));
            const bool of_kind = count == 0 || (waiting[0] < triangle_end) == (slot < triangle_end);
            while (count == 32 || (count != 0 && !of_kind)) ask();
            waiting[count++] = slot;
            prefetch_corners(items, slot);
        }
        first += 64;
    }
    while (count != 0) ask();
}

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "fast/simd/dispatch.h"
#include "nuvo/math/parallel.h"

namespace nuvo {

BigVector<Slot> wanted_items(const LightItems& all, const WantedDepths& wanted, InstructionSet isa,
                             int threads) {
    const std::size_t word_count = (all.scene.slot_end() + 63) / 64;
    std::vector<WantedNode> nodes;
    (NUVO_FOR_ISA(isa, divide_octree))(all, wanted, nodes);
    std::vector<std::vector<std::uint64_t>> marks(static_cast<std::size_t>(threads));  // by thread
    for_each_index(threads, nodes.size(), [&](std::size_t i, int thread) {
        std::vector<std::uint64_t>& mine = marks[static_cast<std::size_t>(thread)];
        mine.resize(word_count);
        (NUVO_FOR_ISA(isa, mark_wanted))(all, wanted, nodes[i], mine.data());
    });
    constexpr std::size_t kWords = 256;  // of a part
    const std::size_t part_count = (word_count + kWords - 1) / kWords;
    std::vector<std::vector<Slot>> parts(part_count);
    for_each_index(threads, part_count, [&](std::size_t part, int) {
        const std::size_t first = part * kWords;
        std::vector<std::uint64_t> words(std::min(kWords, word_count - first));
        for (const std::vector<std::uint64_t>& some : marks)
            for (std::size_t i = 0; !some.empty() && i < words.size(); ++i)
                words[i] |= some[first + i];
        (NUVO_FOR_ISA(isa, choose_wanted))(all, wanted, words, static_cast<Slot>(64 * first),
                                           parts[part]);
    });
    std::size_t size = 0;
    for (const std::vector<Slot>& part : parts) size += part.size();
    BigVector<Slot> slots;
    slots.reserve(size);
    for (const std::vector<Slot>& part : parts) slots.insert(slots.end(), part.begin(), part.end());
    return slots;
}

}  // namespace nuvo
#endif
