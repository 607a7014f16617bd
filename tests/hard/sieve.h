#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "nuvo/scene/scene.h"

namespace nuvo::hard {

/// A conservative filter in 64-bit floats for the oracles: what it rejects is surely not hit. Its
/// slack is thousands of times its rounding.
class Sieve {
  public:
    using Vector = Vec3<long double>;
    struct Item {
        std::size_t object;
        std::size_t triangle;
        Vector low;  ///< the primitive's box
        Vector high;
        long double reach;  ///< largest coordinate of the box
    };

    explicit Sieve(const Scene& scene);

    /// Calls `use(object, triangle)` in document order for each primitive that the ray might hit at
    /// t > 0. `slack`: relative error of the ray's own numbers, and more.
    template <typename Use>
    void each(const Vector& origin, const Vector& direction, long double slack, Use&& use) const {
        for (const Item& item : items_)
            if (may_enter(item, origin, direction, slack) &&
                may_hit(item, origin, direction, slack))
                use(item.object, item.triangle);
    }

  private:
    static bool may_enter(const Item& item, const Vector& origin, const Vector& direction,
                          long double slack);
    bool may_hit(const Item& item, const Vector& origin, const Vector& direction,
                 long double slack) const;

    const Scene& scene_;
    std::vector<Item> items_;
};

}  // namespace nuvo::hard
