#include "repeats.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace nuvo::x3d {

namespace {

/// Mixes words into one (Fowler, Noll and Vo's scheme on words, with a final stir).
class Hash {
  public:
    void add(std::uint64_t word) {
        state_ = (state_ ^ word) * 0x100000001b3;
        state_ ^= state_ >> 29;
    }
    void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
    void add(const Vector3& v) {
        add(v.x);
        add(v.y);
        add(v.z);
    }
    std::uint64_t value() const { return state_; }

  private:
    std::uint64_t state_ = 0xcbf29ce484222325;
};

std::uint64_t hash_of(const Shape& shape) {
    Hash hash;
    hash.add(std::uint64_t{shape.index()});
    if (const auto* sphere = std::get_if<Sphere>(&shape)) {
        hash.add(sphere->center);
        hash.add(sphere->radius);
    } else if (const auto* ellipsoid = std::get_if<Ellipsoid>(&shape)) {
        hash.add(ellipsoid->center);
        hash.add(ellipsoid->radius);
        for (const Vector3& row : ellipsoid->linear.row) hash.add(row);
    } else {
        const auto& mesh = std::get<TriangleMesh>(shape);
        for (const Point3& p : mesh.positions) hash.add(p);
        for (const IndexTriple& t : mesh.triangles) {
            hash.add(std::uint64_t{t[0]} << 32 | t[1]);
            hash.add(std::uint64_t{t[2]});
        }
    }
    return hash.value();
}

bool same_surface(const Shape& a, const Shape& b) {
    if (a.index() != b.index()) return false;
    if (const auto* sphere = std::get_if<Sphere>(&a)) {
        const auto& other = std::get<Sphere>(b);
        return sphere->center == other.center && sphere->radius == other.radius;
    }
    if (const auto* ellipsoid = std::get_if<Ellipsoid>(&a)) {
        const auto& other = std::get<Ellipsoid>(b);
        return ellipsoid->center == other.center && ellipsoid->linear == other.linear &&
               ellipsoid->radius == other.radius;
    }
    const auto &mesh = std::get<TriangleMesh>(a), &other = std::get<TriangleMesh>(b);
    return mesh.triangles == other.triangles && mesh.positions == other.positions;
}

bool hides(const Object& earlier, const Object& later) {
    return (later.solid || !earlier.solid) && (earlier.casts_shadow || !later.casts_shadow) &&
           same_surface(earlier.shape, later.shape);
}

}  // namespace

bool Repeats::is_repeat(const Object& object, const std::vector<Object>& objects) {
    if (2 * (used_ + 1) > slots_.size()) {
        constexpr std::size_t kFirstSize = 64;  // a power of two, as all are
        const std::vector<Slot> old =
            std::exchange(slots_, std::vector<Slot>(std::max(kFirstSize, 2 * slots_.size())));
        for (const Slot& slot : old)
            if (slot.object != kFree) insert(slot);
    }
    const std::uint64_t hash = hash_of(object.shape);
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t i = hash & mask; slots_[i].object != kFree; i = (i + 1) & mask)
        if (slots_[i].hash == hash && hides(objects[slots_[i].object], object)) return true;
    insert({hash, static_cast<std::uint32_t>(objects.size())});
    ++used_;
    return false;
}

void Repeats::insert(Slot slot) {
    const std::size_t mask = slots_.size() - 1;
    std::size_t i = slot.hash & mask;
    while (slots_[i].object != kFree) i = (i + 1) & mask;
    slots_[i] = slot;
}

}  // namespace nuvo::x3d
