#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <mutex>

#include "fast/scene/fast_scene.h"
#include "nuvo/octree/octree.h"
#include "nuvo/render/profile.h"
#include "nuvo/render/render.h"

// Where floats tell too little of a scene the serial tracer of the exact profile takes over, whose
// crowds learn from ray to ray: so that no picture takes much longer than there.

namespace nuvo {

/// What the serial tracer needs of a scene; its octree is built when it is first asked for.
class SerialTree {
  public:
    explicit SerialTree(const FastScene& scene) : scene_(scene), profile_(exact_profile()) {
        profile_.back_faces = scene.back_faces();
    }

    const FastScene& scene() const { return scene_; }
    const Profile& profile() const { return profile_; }
    /// For any number of threads at once.
    const Octree& octree(Progress* progress = nullptr) {
        std::call_once(once_, [&] {
            octree_ = build_tree(scene_.scene(), scene_.primitives(), profile_, progress);
            is_built_ = true;
        });
        return octree_;
    }
    bool is_built() const { return is_built_; }
    std::vector<RayAnswer> closest_hits(std::span<const Ray> rays, Progress* progress) {
        return nuvo::closest_hits(scene_.scene(), scene_.primitives(), &octree(), profile_, rays,
                                  progress);
    }

  private:
    const FastScene& scene_;
    Profile profile_;
    std::once_flag once_;
    std::atomic<bool> is_built_ = false;
    Octree octree_;
};

/// What the octree and so many rays of the serial tracer cost, about, in exact tests of a
/// primitive.
inline std::uint64_t serial_cost(std::uint64_t rays, const FastScene& scene) {
    constexpr std::uint64_t kTestsARay = 64;
    constexpr std::uint64_t kTestsAnItem = 64;
    constexpr std::uint64_t kTestsAReference = 24;  // of the compact octree
    return kTestsARay * rays + kTestsAnItem * scene.slot_end() +
           kTestsAReference * scene.octree().items.size();
}

/// How many exact tests one of the threads that share a picture's pixels may have asked for when it
/// has found so many of them, `step` at a time. Its share of what the serial tracer would cost, so
/// that no picture takes more than twice as long as there: early on fewer, where that would not do
/// by far, and towards the end more, where the rest is likely to cost less than it would there.
inline std::uint64_t allowed_tests(const FastScene& scene, std::uint64_t pixels, int thread_count,
                                   std::uint64_t found, std::uint64_t step) {
    constexpr double kFar = 4;
    const auto threads = static_cast<std::uint64_t>(thread_count);
    const auto cost = [&](std::uint64_t rays) {
        return static_cast<double>(serial_cost(rays * threads, scene) / threads);
    };
    const std::uint64_t part = pixels / threads + 1;
    const std::uint64_t left = std::max(part, found + step) - found;
    const auto done = static_cast<double>(found);
    const double all = cost(part);
    const double early = all * (1 / kFar + kFar * done / static_cast<double>(part));
    const double late = cost(left) * done / static_cast<double>(left);
    return static_cast<std::uint64_t>(std::clamp(late, std::min(early, all), 2 * all));
}

}  // namespace nuvo
