#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <utility>

#include "nuvo/math/error_bounds.h"
#include "nuvo/math/vec.h"

/// What the roundings of a written order of operations can do at the worst, to first order: each
/// number carries, for every rounding that went into it, how much that rounding changes it. A bound
/// below the sum of these is wrong, one far above it wastes tests. Shares nothing with the bounds.
namespace worst_case {

class Number {
  public:
    Number(double value) : value_(value) {}  // NOLINT: exact numbers are numbers
    /// Known within `roundings` roundoffs of itself.
    static Number rounded(double value, int roundings) {
        Number n(value);
        if (value != 0) n.add_share(next_rounding(), roundings * value);
        return n;
    }

    double value() const { return value_; }
    /// The worst sum of all roundings.
    double error() const {
        double sum = 0;
        for (const auto& [rounding, share] : shares_) sum += std::fabs(share);
        return sum * nuvo::kUnitRoundoff;
    }

    /// s a + r b without a rounding of its own.
    static Number combined(const Number& a, double s, const Number& b, double r) {
        return linear(s * a.value_ + r * b.value_, s, a, r, b, false);
    }

    Number operator-() const { return linear(-value_, -1, *this, 0, *this, false); }
    friend Number operator+(const Number& a, const Number& b) {
        return linear(a.value_ + b.value_, 1, a, 1, b, a.value_ != 0 && b.value_ != 0);
    }
    friend Number operator-(const Number& a, const Number& b) {
        return linear(a.value_ - b.value_, 1, a, -1, b, a.value_ != 0 && b.value_ != 0);
    }
    friend Number operator*(const Number& a, const Number& b) {
        const double product = a.value_ * b.value_;
        return linear(product, b.value_, a, a.value_, b, product != 0);
    }
    friend Number operator/(const Number& a, const Number& b) {
        const double quotient = a.value_ / b.value_;
        return linear(quotient, 1 / b.value_, a, -quotient / b.value_, b, quotient != 0);
    }
    friend Number abs(const Number& a) { return a.value_ < 0 ? -a : a; }
    friend Number sqrt(const Number& a) {
        const double root = std::sqrt(a.value_);
        return linear(root, 0.5 / root, a, 0, a, true);
    }

  private:
    static int next_rounding() {
        static int last = 0;
        return ++last;
    }
    void add_share(int rounding, double share) { shares_[rounding] += share; }
    /// value = s a + r b to first order, and a rounding of its own.
    static Number linear(double value, double s, const Number& a, double r, const Number& b,
                         bool rounds) {
        Number n(value);
        for (const auto& [rounding, share] : a.shares_) n.add_share(rounding, s * share);
        if (r != 0)
            for (const auto& [rounding, share] : b.shares_) n.add_share(rounding, r * share);
        if (rounds) n.add_share(next_rounding(), value);
        return n;
    }

    double value_;
    std::map<int, double> shares_;  // by rounding, in units of u
};

struct Vector {
    Number x, y, z;

    Vector(Number x_in, Number y_in, Number z_in)
        : x(std::move(x_in)), y(std::move(y_in)), z(std::move(z_in)) {}
    explicit Vector(const nuvo::Vector3& v) : x(v.x), y(v.y), z(v.z) {}
    /// The rounded difference of two points, or a direction without its tail.
    static Vector rounded(const nuvo::Vector3& v) {
        return {Number::rounded(v.x, 1), Number::rounded(v.y, 1), Number::rounded(v.z, 1)};
    }
    const Number& operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
    nuvo::Vector3 value() const { return {x.value(), y.value(), z.value()}; }
    /// The worst error of n . this, for an exact n.
    double error_along(const nuvo::Vector3& n) const {
        return Number::combined(Number::combined(x, n.x, y, n.y), 1, z, n.z).error();
    }

    Vector operator-() const { return {-x, -y, -z}; }
    friend Vector operator+(const Vector& a, const Vector& b) {
        return {a.x + b.x, a.y + b.y, a.z + b.z};
    }
    friend Vector operator-(const Vector& a, const Vector& b) {
        return {a.x - b.x, a.y - b.y, a.z - b.z};
    }
    friend Vector operator*(const Vector& v, const Number& s) {
        return {v.x * s, v.y * s, v.z * s};
    }
    friend Number dot(const Vector& a, const Vector& b) {
        return a.x * b.x + a.y * b.y + a.z * b.z;
    }
    friend Vector cross(const Vector& a, const Vector& b) {
        return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    }
};

/// The least quotient of a bound and the worst error; none may be below 1.
struct Tightness {
    const char* name;
    double least = std::numeric_limits<double>::infinity();

    void add(double bound, double worst) {
        // The sum of the shares is itself rounded.
        EXPECT_GE(bound, worst * (1 - 0x1p-40)) << name;
        if (worst > 0) least = std::fmin(least, bound / worst);
    }
};

class Draw {
  public:
    explicit Draw(unsigned seed) : engine_(seed) {}
    double uniform(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(engine_);
    }
    /// 2^low .. 2^high.
    double size(double low, double high) { return std::exp2(uniform(low, high)); }
    nuvo::Vector3 vector() { return {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)}; }
    int below(int n) { return static_cast<int>(engine_() % static_cast<unsigned>(n)); }

  private:
    std::mt19937_64 engine_;
};

}  // namespace worst_case
