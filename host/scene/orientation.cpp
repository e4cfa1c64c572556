// SPDX-License-Identifier: Apache-2.0
#include "host/scene/orientation.h"

#include <cmath>
#include <limits>

namespace rt {
namespace {

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

/// The orientation of exact differences.
int exact_orientation(double ax, double ay, double bx, double by) {
    ExactSum sum;
    sum.add_product(ax, by);
    sum.add_product(-ay, bx);
    return sum.sign_of();
}

/// Whether a - b was inexact (Knuth's two-sum).
bool is_rounded(double a, double b, double difference) {
    const double back = a - difference;
    return (a - (difference + back)) + (back - b) != 0;
}

}  // namespace

int orientation(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c) {
    const double ax = a.x - c.x, ay = a.y - c.y, bx = b.x - c.x, by = b.y - c.y;
    const double left = ax * by, right = ay * bx;
    const double bound =
        2 * std::numeric_limits<double>::epsilon() * (std::abs(left) + std::abs(right));
    const double area = left - right;
    if (std::abs(area) > bound) return sign(area);
    if ((ax == 0 || by == 0) && (ay == 0 || bx == 0)) return 0;
    if (is_rounded(a.x, c.x, ax) || is_rounded(a.y, c.y, ay) || is_rounded(b.x, c.x, bx) ||
        is_rounded(b.y, c.y, by)) {
        return exact_orientation(a, b, c);
    }
    return exact_orientation(ax, ay, bx, by);
}

}  // namespace rt
