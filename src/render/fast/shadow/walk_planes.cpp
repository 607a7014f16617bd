#include "fast/shadow/walk_planes.h"

#include <algorithm>

namespace nuvo {

void WalkPlanes::make(Batch& batch, std::size_t light, Slot first) {
    const FastScene& scene = tables_.scene();
    chunk_.fetch(scene, {}, first,
                 std::min<Slot>(first + TriangleBatch::kSize, scene.triangle_end()));
    // Written from place 0 on.
    chunk_.last -= chunk_.first;
    chunk_.first = 0;
    make_shadow_planes({scene, tables_.table(light).light, batch.planes, &batch.hides,
                        scene.scene().lights[light]},
                       chunk_, tables_.isa());
    batch.first = first;
    batch.light = light;
}

}  // namespace nuvo
