#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "nuvo/math/vec.h"

namespace nuvo {

/// significand * 2^exponent: a double whose exponent neither over- nor underflows. Each operation
/// has a relative error of at most one unit roundoff; the significand is 0 or in [1/2, 1).
class WideDouble {
  public:
    WideDouble() = default;
    /// `significand` finite.
    explicit WideDouble(double significand, std::int64_t exponent = 0);

    double significand() const { return significand_; }
    std::int64_t exponent() const { return exponent_; }
    /// Rounded to double; beyond its range to the infinities or towards 0.
    double rounded() const;

    friend WideDouble operator+(const WideDouble& a, const WideDouble& b);
    friend WideDouble operator*(const WideDouble& a, const WideDouble& b);
    friend WideDouble operator/(const WideDouble& a, const WideDouble& b);
    friend WideDouble sqrt(const WideDouble& a);

  private:
    double significand_ = 0;
    std::int64_t exponent_ = 0;
};

/// A dyadic rational without limits: sign * integer * 2^(64 k). Sums, differences and products of
/// finite doubles are exact, whatever their exponents (subnormals included). The integer is held in
/// 64-bit limbs on a grid common to all values, so that sums need no shifts; small ones lie in the
/// object itself.
class Exact {
  public:
    Exact() = default;
    /// Exactly `value`, which is finite.
    explicit Exact(double value);
    Exact(const Exact& other) { assign(other); }
    Exact(Exact&& other) noexcept { take(other); }
    Exact& operator=(const Exact& other);
    Exact& operator=(Exact&& other) noexcept;
    ~Exact() = default;

    /// -1, 0 or 1.
    int sign() const { return size_ == 0 ? 0 : negative_ ? -1 : 1; }
    /// The value with a relative error below two unit roundoffs.
    WideDouble approximate() const;

    Exact operator-() const;
    friend Exact operator+(const Exact& a, const Exact& b) { return sum(a, b, false); }
    friend Exact operator-(const Exact& a, const Exact& b) { return sum(a, b, true); }
    friend Exact operator*(const Exact& a, const Exact& b) { return product(a, b); }

  private:
    using Limb = std::uint64_t;
    static constexpr std::size_t kInline = 12;

    static Exact sum(const Exact& a, const Exact& b, bool negate_b);
    static Exact product(const Exact& a, const Exact& b);
    /// Space for `size` limbs of any content.
    Limb* allocate(std::size_t size);
    const Limb* limbs() const { return large_.empty() ? small_.data() : large_.data(); }
    Limb* limbs() { return large_.empty() ? small_.data() : large_.data(); }
    void assign(const Exact& other);
    void take(Exact& other) noexcept;
    /// Drops zero limbs at both ends.
    void trim();

    std::array<Limb, kInline> small_;  ///< the first size_ are meant, unless large_ holds them
    std::vector<Limb> large_;
    std::size_t size_ = 0;
    std::int64_t exponent_ = 0;  ///< in limbs
    bool negative_ = false;
};

using ExactVector = Vec3<Exact>;

/// |a|, and the sign of a - b.
inline Exact abs(const Exact& a) { return a.sign() < 0 ? -a : a; }
inline int compare(const Exact& a, const Exact& b) { return (a - b).sign(); }

}  // namespace nuvo
