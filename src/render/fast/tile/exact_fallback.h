#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "crowd.h"
#include "exact_kernel.h"
#include "fast/scene/fast_scene.h"
#include "fast/tile/camera_rays.h"
#include "fast/tile/tile.h"
#include "leaf_boxes.h"
#include "surface_color.h"

// What the float stages of the fast tracer leave open is decided here, pixel by pixel, by the very
// predicates of the serial tracer (geometry/predicates.h): so the pictures are the same.

namespace nuvo {

/// Decides for one thread.
class ExactFallback {
    using Kernel = ExactKernelOf<SceneStore>;

  public:
    ExactFallback(const FastScene& scene, const CameraRays& camera)
        : scene_(scene),
          camera_(camera),
          kernel_(scene.scene(), scene.primitives(), std::nullopt, scene.back_faces()) {}

    const FastScene& scene() const { return scene_; }
    /// What has been found so far, of use for other pictures.
    StageCounts& stage_counts() { return kernel_.stage_counts(); }

    /// A hit found exactly: bounds on q, and for a quadric its normal.
    struct Nearest {
        float low;
        float high;
        Vector3 normal;
    };
    /// The hit of pixel (x, y) on `slot`, if there is one and it comes before the one on `other`
    /// (kNoSlot: none).
    std::optional<Nearest> nearer(int x, int y, Slot slot, Slot other) const;

    /// The shadow ray to a light from the point that pixel (x, y) shows on `lit`.
    Kernel::Shadow shadow_ray(int x, int y, Slot lit, std::size_t light) const;
    /// Whether `blocked` says so of that ray, or of the other one of the same point, if it has two.
    template <typename Blocked>
    bool any_way(const Kernel::Shadow& ray, Blocked&& blocked) const {
        return kernel_.any_way(ray, blocked);
    }
    /// Whether `occluder` stands on that ray. Most that floats leave open does not even come near,
    /// which a box tells at less cost.
    bool blocks(const Kernel::Shadow& ray, Slot occluder) const {
        const PrimitiveId id = scene_.id(occluder);
        return comes_near(ray, occluder) &&
               (!may_test(tests_of(occluder)) || kernel_.blocks(ray, {id, id + 1}));
    }
    /// Whether `occluder` may do so, by its box.
    bool comes_near(const Kernel::Shadow& ray, Slot occluder) const {
        return occluder >= scene_.triangle_end() || box_comes_near(ray, scene_.id(occluder));
    }
    /// Whether any item of a leaf of the octree does; for leaves of which many come near the ray:
    /// what some rays have found is kept. [crowd.h]
    bool blocks_any(const Kernel::Shadow& ray, std::span<const Slot> leaf) const;

    /// How many tests of a primitive may be asked for in all; not called: any number.
    void allow(std::uint64_t tests) { allowed_ = kLeavesOfTest * tests; }
    /// A walk for a single ray came to one more leaf, of so many items; false: it may end.
    bool may_visit(std::uint32_t items) const { return may_spend(1 + kLookAtItem * items); }
    /// More were asked for, then or once before: the last answers may have been wrong.
    bool is_exhausted() const { return is_exhausted_; }

    /// The pixel's color, given what it shows (kNoSlot: the background) and which lights are not
    /// blocked (bit i of the predicate; lights that do not cast shadows are asked for, too).
    template <typename Unblocked>
    Color color(int x, int y, Slot slot, Unblocked&& unblocked) const {
        const Ray ray = camera_.rays.ray(x, y);
        if (slot == kNoSlot) return scene_.scene().background.color(ray.direction);
        const ExactRay prepared = kernel_.prepare(ray);
        const Kernel::Hit hit = *kernel_.hit_of(prepared, scene_.id(slot));
        return surface_color(scene_.scene(), kernel_, prepared, hit, ray,
                             [&](const auto&, std::size_t light) { return unblocked(light); });
    }

  private:
    struct LargeLeaf {
        LargeLeaf(const FastScene& scene, const Kernel& kernel, std::span<const Slot> slots)
            : ids(ids_of(scene, slots)), crowd(kernel, scene.primitives(), ids) {}
        static std::vector<PrimitiveId> ids_of(const FastScene& scene,
                                               std::span<const Slot> slots) {
            std::vector<PrimitiveId> out;
            out.reserve(slots.size());
            for (const Slot slot : slots) out.push_back(scene.id(slot));
            return out;
        }

        std::vector<PrimitiveId> ids;
        Crowd<Kernel> crowd;
    };

    // Of the pixels of a tile, the latest: each light asks for them.
    struct Surface {
        int x = -1;
        int y = -1;
        Slot slot = kNoSlot;
        Kernel::Surface surface{};
    };
    const Kernel::Surface& surface(int x, int y, Slot lit) const;

    bool box_comes_near(const Kernel::Shadow& ray, PrimitiveId id) const {
        return !Slabs(ray.ray).surely_missed(scene_.primitives().item_boxes[id], ray.end);
    }

    // What counts is leaves: so many cost as much as a test.
    static constexpr std::uint64_t kLeavesOfTest = 32;
    static constexpr std::uint64_t kLookAtItem = 2;
    // A pixel's ray is made, meets two primitives, and these are compared.
    static constexpr std::uint64_t kTestsOfPixel = 4;
    static constexpr std::uint64_t kTestsOfEllipsoid = 4;
    std::uint64_t tests_of(Slot slot) const {
        return slot < scene_.sphere_end() ? 1 : kTestsOfEllipsoid;
    }
    bool may_test(std::uint64_t tests) const { return may_spend(kLeavesOfTest * tests); }
    bool may_spend(std::uint64_t leaves) const {
        spent_ += leaves;
        if (spent_ > allowed_) is_exhausted_ = true;
        return !is_exhausted_;
    }

    const FastScene& scene_;
    const CameraRays& camera_;
    Kernel kernel_;
    std::uint64_t allowed_ = std::numeric_limits<std::uint64_t>::max();
    mutable std::uint64_t spent_ = 0;
    mutable bool is_exhausted_ = false;
    mutable std::unordered_map<const Slot*, LargeLeaf> large_leaves_;  // by their first items
    mutable std::array<Surface, kTileLanes> surfaces_{};
};

}  // namespace nuvo
