#pragma once

#include "exact_kernel.h"
#include "nuvo/render/profile.h"
#include "plain_kernel.h"
#include "search.h"

// The choices of a profile, made once a picture: below them every inner loop is an instance of its
// own.

namespace nuvo {

/// Calls `use(kernel)` with the kernel that the profile's precision and bias ask for.
template <typename Use>
auto with_kernel(const Scene& scene, const Primitives& primitives, const Profile& profile,
                 Use&& use) {
    switch (profile.precision) {
        case Precision::kFloat:
            return use(PlainKernel<float>(scene, primitives, profile.bias, profile.back_faces));
        case Precision::kDouble:
            return use(PlainKernel<double>(scene, primitives, profile.bias, profile.back_faces));
        case Precision::kExact:
            break;
    }
    return use(ExactKernel(scene, primitives, profile.bias, profile.back_faces));
}

/// Calls `use(search)` with the search that the profile's walk and step ask for.
template <typename Kernel, typename Counter, typename Use>
auto with_search(const Kernel& kernel, const Primitives& primitives, const Octree& octree,
                 const Profile& profile, Counter counter, Use&& use) {
    const auto with_locator = [&]<typename Locator>(Locator) {
        if (profile.step)
            return use(NudgedSearch<Kernel, Locator, Counter>(kernel, primitives, octree,
                                                              *profile.step, counter));
        return use(ExactSearch<Kernel, Locator, Counter>(kernel, primitives, octree, counter));
    };
    // A tree that was built for the other walk has no names.
    if (profile.walk == WalkChoice::kHash && !octree.names().empty())
        return with_locator(HashLocator{});
    return with_locator(DescentLocator{});
}

}  // namespace nuvo
