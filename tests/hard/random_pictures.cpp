#include <algorithm>
#include <mutex>
#include <ostream>
#include <sstream>

#include "classes.h"
#include "lights.h"
#include "nuvo/math/parallel.h"
#include "nuvo/render/render.h"
#include "pictures.h"
#include "threads.h"

namespace nuvo::hard {
namespace {

constexpr Resolution kSize{32, 18};
constexpr Resolution kSmall{20, 12};

Camera camera_towards(const Point3& eye, const Point3& target, double field_of_view) {
    Camera camera;
    camera.position = eye;
    camera.forward = normalized(target - eye);
    if (camera.forward == Vector3{}) camera.forward = {0, 0, -1};
    const Vector3 side = cross(camera.forward, {0.3, 1, 0.1});
    camera.right = normalized(side);
    camera.up = cross(camera.right, camera.forward);
    camera.field_of_view_rad = field_of_view;
    return camera;
}

PictureCheck check_one(std::uint64_t number, std::uint64_t seed, Lighting lighting,
                       std::ostream& faults) {
    const auto classes = hard_classes();
    const HardClass& hard_class = classes[number % classes.size()];
    Random random(mixed_seed(seed, 2000, number),
                  static_cast<Coordinates>(number / classes.size() % 3));
    Scene scene = hard_class.scene(random);
    const Primitives primitives = flatten(scene, LeafContent::kPrimitives);
    const Octree octree = build_tree(scene, primitives, exact_profile());
    Aims aims(scene, octree, random);
    lighting == Lighting::kRich ? light_richly(scene, aims, random)
                                : light_from_hard_places(scene, aims, random);
    const Object& target = aims.object();
    const double size = aims.half_size(target);
    const Point3 eye =
        random.chance() ? aims.middle(target) + random.unit() * (4 * size) : aims.outside();
    scene.camera = camera_towards(eye, aims.middle(target), 0.7);
    std::ostringstream found;
    const Image image = picture(scene, lighting == Lighting::kRich ? kSmall : kSize);
    PictureCheck check = check_picture(scene, image, found, true);
    check.fast_differs = fast_differences(scene, image);
    if (check.fast_differs > 0)
        found << check.fast_differs << " pixels by the fast tracer differ\n";
    if (check.wrong() > 0 || check.fast_differs > 0)
        faults << hard_class.name << " scene " << number << " seed " << seed << "\n" << found.str();
    return check;
}

}  // namespace

bool check_random_pictures(std::uint64_t count, std::uint64_t seed, unsigned threads,
                           std::ostream& out, Lighting lighting) {
    std::mutex mutex;
    PictureCheck sum;
    for_each_index(thread_count(threads), count, [&](std::size_t i, int) {
        std::ostringstream faults;
        const PictureCheck check = check_one(i, seed, lighting, faults);
        const std::lock_guard lock(mutex);
        sum.pixels += check.pixels;
        sum.off += check.off;
        sum.masked += check.masked;
        sum.rounded += check.rounded;
        sum.fast_differs += check.fast_differs;
        out << faults.str();
    });
    out << count << " scenes, " << sum.pixels << " pixels: " << sum.masked
        << " off on the silhouette mask, " << sum.rounded
        << " where the rounding of the lit point decides, " << sum.wrong() << " off elsewhere, "
        << sum.fast_differs << " differ by the fast tracer, seed " << seed << "\n";
    return sum.wrong() == 0 && sum.fast_differs == 0;
}

}  // namespace nuvo::hard
