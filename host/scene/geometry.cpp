// SPDX-License-Identifier: Apache-2.0
#include "host/scene/geometry.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <numbers>

namespace rt {
namespace {

constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();

/// Scales every axis by its own power of two, exactly, so that its largest coordinate lies in
/// 0.5..1 (or is 0). Collinearity is unchanged.
std::array<glm::dvec3, 3> scaled_per_axis(std::array<glm::dvec3, 3> corners) {
    for (int axis = 0; axis < 3; ++axis) {
        double size = 0;
        for (const glm::dvec3& corner : corners) size = std::max(size, std::abs(corner[axis]));
        int exponent = 0;
        std::frexp(size, &exponent);
        for (glm::dvec3& corner : corners) corner[axis] = std::ldexp(corner[axis], -exponent);
    }
    return corners;
}

/// Whether one component of the normal exceeds any rounding error: true for most triangles, and far
/// cheaper than scaling them. Scaling is by at most twice the coordinates, so it stays above the
/// largest error that zero_area allows (8 roundings).
bool clearly_has_area(const std::array<glm::dvec3, 3>& corners) {
    const auto& [a, b, c] = corners;
    const glm::dvec3 size = glm::max(glm::max(glm::abs(a), glm::abs(b)), glm::abs(c));
    const glm::dvec3 normal = glm::abs(glm::cross(b - a, c - a));
    constexpr double slack = 64 * rounding;
    return normal.x > slack * (size.y * size.z) || normal.y > slack * (size.z * size.x) ||
           normal.z > slack * (size.x * size.y);
}

/// The columns of the inverse transpose times the determinant.
glm::dmat3 cofactors(const glm::dmat3& m) {
    return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
}

double determinant(const glm::dmat3& m) { return glm::dot(m[0], glm::cross(m[1], m[2])); }

double largest_entry(const glm::dmat3& m) {
    double size = 0;
    for (int i = 0; i < 9; ++i) size = std::max(size, std::abs(m[i / 3][i % 3]));
    return size;
}

/// Normalizes the columns; empty if one is zero.
std::optional<glm::dmat3> unit_columns(const glm::dmat3& m) {
    glm::dmat3 result(0);
    for (int i = 0; i < 3; ++i) {
        const auto unit = unit_direction(m[i]);
        if (!unit) return std::nullopt;
        result[i] = *unit;
    }
    return result;
}

/// Scales rows and columns to about unit length, so that the determinant depends only on angles.
std::optional<glm::dmat3> without_scales(const glm::dmat3& m) {
    const auto columns = unit_columns(m);
    return columns ? unit_columns(glm::transpose(*columns)) : std::nullopt;
}

/// Sine and cosine, exact for whole quarter turns.
void sine_cosine(double degrees, double& sine, double& cosine) {
    const double turn = std::fmod(degrees, 360.0);
    const double quarters = std::nearbyint(turn / 90.0);
    const double angle = (turn - 90.0 * quarters) * (std::numbers::pi / 180.0);
    const double s = std::sin(angle), c = std::cos(angle);
    const double sines[] = {s, c, -s, -c}, cosines[] = {c, -s, -c, s};
    const int which = static_cast<int>(quarters) & 3;
    sine = sines[which];
    cosine = cosines[which];
}

/// The rotation that turns `from` toward `to` (axis numbers).
glm::dmat3 rotation(double degrees, int from, int to) {
    double sine = 0, cosine = 1;
    sine_cosine(degrees, sine, cosine);
    glm::dmat3 m(1);
    m[from][from] = m[to][to] = cosine;
    m[from][to] = sine;
    m[to][from] = -sine;
    return m;
}

/// Whether two unit vectors are parallel: the sine of their angle is below 1e-9.
bool nearly_parallel(glm::dvec3 a, glm::dvec3 b) { return largest(glm::cross(a, b)) < 1e-9; }

int sign(double x) { return (x > 0) - (x < 0); }

/// An exact sum of doubles: components of increasing magnitude whose bits do not overlap.
class ExactSum {
   public:
    void add(double x) {
        for (int i = 0; i < count_; ++i) {
            const double sum = x + parts_[i];
            const double of_part = sum - x;
            parts_[i] = (x - (sum - of_part)) + (parts_[i] - of_part);
            x = sum;
        }
        parts_[count_++] = x;
    }

    void add_product(double a, double b) {
        const double product = a * b;
        add(std::fma(a, b, -product));
        add(product);
    }

    /// The largest nonzero component determines the sign.
    int sign_of() const {
        for (int i = count_; i-- > 0;) {
            if (parts_[i] != 0) return sign(parts_[i]);
        }
        return 0;
    }

   private:
    double parts_[12] = {};
    int count_ = 0;
};

int exact_orientation(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c) {
    ExactSum sum;
    sum.add_product(a.x, b.y);
    sum.add_product(-a.y, b.x);
    sum.add_product(b.x, c.y);
    sum.add_product(-b.y, c.x);
    sum.add_product(c.x, a.y);
    sum.add_product(-c.y, a.x);
    return sum.sign_of();
}

}  // namespace

std::optional<glm::dvec3> unit_direction(glm::dvec3 v) {
    const double size = largest(v);
    if (size == 0) return std::nullopt;
    const glm::dvec3 scaled(v.x / size, v.y / size, v.z / size);
    return scaled / glm::length(scaled);
}

bool nearly_same_point(glm::dvec3 a, glm::dvec3 b) {
    for (int axis = 0; axis < 3; ++axis) {
        const double size = std::max(std::abs(a[axis]), std::abs(b[axis]));
        if (std::abs(a[axis] - b[axis]) > rounding * size) return false;
    }
    return true;
}

/// Each component of the edges carries one rounding error (the coordinates are at most 1 after
/// scaling), so the cross product counts as zero below the resulting error bound.
bool zero_area(const std::array<glm::dvec3, 3>& corners) {
    if (clearly_has_area(corners)) return false;
    const auto [a, b, c] = scaled_per_axis(corners);
    const glm::dvec3 e = b - a, f = c - a;
    const glm::dvec3 normal = glm::cross(e, f);
    const auto vanishes = [&](int x, int y, int z) {
        const double error =
            rounding * (std::abs(e[y]) + std::abs(f[y]) + std::abs(e[z]) + std::abs(f[z]));
        return std::abs(normal[x]) <= error;
    };
    return vanishes(0, 1, 2) && vanishes(1, 2, 0) && vanishes(2, 0, 1);
}

std::optional<AxesMistake> find_axes_mistake(glm::dvec3 from, glm::dvec3 at, glm::dvec3 up) {
    if (nearly_same_point(from, at)) {
        return AxesMistake{false, "from and at are the same point; move one of them"};
    }
    const auto view = unit_direction(at - from);
    const auto up_direction = unit_direction(up);
    if (!up_direction) {
        return AxesMistake{true, "up is zero; write the direction that points up in the picture"};
    }
    if (nearly_parallel(*view, *up_direction)) {
        return AxesMistake{true, "up is parallel to the view direction; choose another direction"};
    }
    return std::nullopt;
}

Affine make_affine(glm::dvec3 scale, glm::dvec3 degrees, glm::dvec3 translation) {
    const glm::dmat3 turn =
        rotation(degrees.z, 0, 1) * rotation(degrees.y, 2, 0) * rotation(degrees.x, 1, 2);
    return {{turn[0] * scale.x, turn[1] * scale.y, turn[2] * scale.z}, translation};
}

glm::dvec3 turned(glm::dvec3 v, glm::dvec3 axis, double degrees) {
    double sine = 0, cosine = 1;
    sine_cosine(degrees, sine, cosine);
    return cosine * v + sine * glm::cross(axis, v) + (1 - cosine) * glm::dot(axis, v) * axis;
}

std::optional<glm::dmat3> normal_matrix(const glm::dmat3& linear) {
    constexpr double smallest = 1e-12;
    const auto bare = without_scales(linear);
    if (!bare || !(std::abs(determinant(*bare)) > smallest)) return std::nullopt;
    const double size = largest_entry(linear);
    glm::dmat3 scaled = linear;
    for (int i = 0; i < 9; ++i) scaled[i / 3][i % 3] /= size;
    glm::dmat3 result = cofactors(scaled);
    if (mirrors(linear)) result *= -1.0;
    return result;
}

bool mirrors(const glm::dmat3& linear) {
    const auto bare = without_scales(linear);
    return bare && determinant(*bare) < 0;
}

int orientation(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c) {
    const double ax = a.x - c.x, ay = a.y - c.y, bx = b.x - c.x, by = b.y - c.y;
    const double left = ax * by, right = ay * bx;
    const double bound =
        2 * std::numeric_limits<double>::epsilon() * (std::abs(left) + std::abs(right));
    const double area = left - right;
    if (std::abs(area) > bound) return sign(area);
    if ((ax == 0 || by == 0) && (ay == 0 || bx == 0)) return 0;
    return exact_orientation(a, b, c);
}

}  // namespace rt
