#include "fast/shading/shading.h"

#include "nuvo/math/error_bounds.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fast/shading/shading_surface.cpp"
#include <hwy/foreach_target.h>

#include "fast/shading/smooth_normals.h"
#include "fast/simd/lanes.h"
#include "fast/simd/vector_math.h"

// Points of all lanes from q; words of their materials; and for spheres, interpolated normals
// and colors the slower way of smooth_normals.h.

HWY_BEFORE_NAMESPACE();
namespace nuvo::HWY_NAMESPACE {

class SurfaceFiller {
  public:
    SurfaceFiller(const ShadingTables& tables, Tile& tile, ShadingScratch& scratch)
        : tables_(tables),
          tile_(tile),
          scratch_(scratch),
          triangle_end_(tables.scene.triangle_end()) {}

    void run() {
        for (int b = 0; b < kTileBlocks; ++b) {
            scratch_.lit_material[b] = 0;
            scratch_.smooth[b] = 0;
            scratch_.colored[b] = 0;
            if (tile_.hit[b] != 0) fill(b);
        }
    }

  private:
    HWY_INLINE void fill(int b) {
        const int first = b * kBlockLanes;
        const std::uint32_t hit = tile_.hit[b];
        clear_sums(first);
        const BlockDirections directions(tables_, tile_, b);
        fill_points(first, directions);
        const Ints slot = Ints::load(tile_.slot + first);
        const auto triangle = (slot > Ints(-1)) & (slot < Ints(triangle_end_));
        const std::uint32_t triangles = triangle_end_ == 0 ? 0 : triangle.bits();
        std::uint32_t special = hit & ~triangles;  // lanes of smooth_normals.h
        std::uint32_t unlit = (tables_.common_word & kUnlitFlag) != 0 ? 0xffff : 0;
        if (!tables_.uniform) {
            Ints word(0);
            if (triangles != 0)
                word = Ints::gather(
                    reinterpret_cast<const std::int32_t*>(tables_.triangles.words.data()),
                    select(triangle, slot, Ints(0)));
            word.store(scratch_.word + first);
            special |= flagged(word, kSmoothFlag | kColoredFlag) & triangles;
            unlit = flagged(word, kUnlitFlag) & triangles;
        }
        if (!tables_.triangles.normals.empty() && triangles != 0)
            gather_normals(first, select(triangle, slot, Ints(0)));
        if (special != 0) {
            SmoothNormalLanes(tables_, tile_, scratch_, directions, b).fill(special);
            if (!tables_.uniform) unlit = flagged(Ints::load(scratch_.word + first), kUnlitFlag);
        }
        if ((tables_.any_flags & kSpecularFlag) != 0) fill_view(first, directions);
        scratch_.lit_material[b] = static_cast<std::uint16_t>(hit & ~unlit);
    }

    static HWY_INLINE std::uint32_t flagged(const Ints& word, SurfaceWord flags) {
        return ((word & Ints(flags)) != Ints(0)).bits();
    }

    HWY_INLINE void clear_sums(int first) {
        const Floats zero(0.0F);
        for (int c = 0; c < tables_.channels; ++c) zero.store(scratch_.diffuse[c] + first);
        Floats(tables_.sound ? 0.0F : kFloatInfinity).store(scratch_.diffuse_error + first);
        if ((tables_.any_flags & kSpecularFlag) == 0) return;
        for (int c = 0; c < tables_.channels; ++c) zero.store(scratch_.specular[c] + first);
        zero.store(scratch_.specular_error + first);
    }

    // A point is at t directions from where its ray starts. In perspective t is 1 / q: with w the
    // relative width of the bounds on q it is off by a relative w / 2 + w^2 / 2 at most, for 1 / (1
    // - w / 2) <= 1 + w / 2 + w^2 / 2 where w <= 1. In a parallel projection it is -q.
    HWY_INLINE void fill_points(int first, const BlockDirections& directions) {
        const ShadingBounds& bounds = tables_.bounds;
        const CameraRays& camera = tables_.camera;
        const Floats low = Floats::load(tile_.near_low + first);
        const Floats high = Floats::load(tile_.near_high + first);
        const Floats q = (low + high) * Floats(0.5F);
        Floats t = -q;
        Floats width = high - low;
        Floats relative = width;
        if (!camera.parallel) {
            t = reciprocal(q);
            relative = width * t;
            width = t * mul_add(relative, relative, relative);
        }
        Floats largest(0.0F);
        for (int axis = 0; axis < 3; ++axis) {
            const Floats start = camera.parallel ? directions.start(axis)
                                                 : Floats(static_cast<float>(camera.origin[axis]));
            const Floats x = mul_add(t, directions.at(axis), start);
            x.store(tile_.point[axis] + first);
            largest = max(largest, abs(x));
        }
        const Floats error =
            mul_add(abs(t), Floats(bounds.point_by_t),
                    mul_add(width, Floats(kSlack / 2 * tables_.rays.longest),
                            mul_add(largest, Floats(roundings(2)), Floats(bounds.point_constant))));
        select(relative < Floats(1.0F), error, Floats(kFloatInfinity))
            .store(tile_.point_error + first);
    }

    HWY_INLINE void gather_normals(int first, const Ints& slot) {
        const Ints at = shift_left<2>(slot);
        for (int axis = 0; axis < 3; ++axis)
            Floats::gather(tables_.triangles.normals.data() + axis, at)
                .store(tile_.normal[axis] + first);
    }

    HWY_INLINE void fill_view(int first, const BlockDirections& directions) {
        const Floats inverse = -inverse_sqrt(directions.square());
        for (int axis = 0; axis < 3; ++axis)
            (directions.at(axis) * inverse).store(scratch_.view[axis] + first);
    }

    const ShadingTables& tables_;
    Tile& tile_;
    ShadingScratch& scratch_;
    Slot triangle_end_;
};

void fill_surface(const ShadingTables& tables, Tile& tile, ShadingScratch& scratch) {
    SurfaceFiller(tables, tile, scratch).run();
}

}  // namespace nuvo::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "fast/simd/dispatch.h"

namespace nuvo {

void pick_surface_kernel(InstructionSet isa, ShadingKernels& kernels) {
    kernels.surface = NUVO_FOR_ISA(isa, fill_surface);
}

}  // namespace nuvo
#endif
