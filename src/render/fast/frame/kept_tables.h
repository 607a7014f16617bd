#pragma once

#include <optional>
#include <vector>

#include "fast/shading/shading_tables.h"
#include "fast/shadow/pair_shadows.h"
#include "fast/shadow/shadow_tables.h"

namespace nuvo {

/// What one picture leaves to the next ones of its scene while the lights stay where they are: the
/// shadow tables, which do not depend on the camera if they are of all items and else serve points
/// for which they are known to list enough; what each thread knows of pairs of triangles and of
/// exact signs; and what shading knows of triangles.
class KeptTables {
  public:
    /// Before a picture. Forgets what was kept for other lights.
    void begin(const FastScene& scene, int threads) {
        if (lights_ != scene.scene().lights) {
            shadows_.reset();
            threads_.clear();
            shading.reset();
            lights_ = scene.scene().lights;
        }
        while (threads_.size() < static_cast<std::size_t>(threads)) threads_.emplace_back(scene);
    }
    /// Null: there are none for these lights.
    const ShadowTables* shadows() const { return shadows_ ? &*shadows_ : nullptr; }
    /// Whether they were made for the very points that this camera shows.
    bool serve_all_of(const Camera& camera, Resolution resolution) const {
        return shadows_ && camera_ == camera && resolution_ == resolution;
    }
    void forget_shadows() { shadows_.reset(); }
    /// Frees the shadow tables that are kept, and keeps what `make` returns instead.
    template <typename Make>
    const ShadowTables& keep_shadows(const Camera& camera, Resolution resolution, Make&& make) {
        shadows_.reset();
        camera_ = camera;
        resolution_ = resolution;
        return shadows_.emplace(make());
    }
    /// What one thread knows.
    struct OfThread {
        explicit OfThread(const FastScene& scene) : pairs(scene) {}
        PairShadows pairs;
        StageCounts stages;  ///< taken by the thread's fallback, and given back
    };
    OfThread& of_thread(int thread) { return threads_[static_cast<std::size_t>(thread)]; }
    /// Bytes of what the threads know; between two pictures.
    std::size_t thread_bytes() const {
        std::size_t bytes = 0;
        for (const OfThread& thread : threads_)
            bytes += thread.pairs.memory_bytes() + thread.stages.memory_bytes();
        return bytes;
    }

    std::optional<ShadingTriangles> shading;  ///< taken by a picture, and given back

  private:
    std::vector<Light> lights_;
    std::optional<ShadowTables> shadows_;
    Camera camera_;  // of the picture that they were made for
    Resolution resolution_;
    std::vector<OfThread> threads_;
};

}  // namespace nuvo
