// Integrals in double precision for references: Gauss's rule on one interval, and on the pieces of one whose
// function has kinks.
#pragma once

#include <cmath>
#include <map>
#include <numbers>
#include <vector>

namespace candela {

// Gauss's points and weights on [0, 1]. Ref: Press et al., Numerical Recipes, section 4.6 (Newton's iteration
// on Legendre's polynomials).
struct GaussRule {
    std::vector<double> x, weight;

    explicit GaussRule(int order) {
        for (int i = 1; i <= order; ++i) {
            double z = std::cos(std::numbers::pi * (i - 0.25) / (order + 0.5)), slope = 1;
            for (int iteration = 0; iteration < 100; ++iteration) {
                double p = 1, previous = 0;
                for (int k = 1; k <= order; ++k) {
                    const double before = previous;
                    previous = p;
                    p = ((2 * k - 1) * z * previous - (k - 1) * before) / k;
                }
                slope = order * (z * p - previous) / (z * z - 1);
                const double step = p / slope;
                z -= step;
                if (std::abs(step) < 1e-15) break;
            }
            x.push_back(0.5 * (1 - z));
            weight.push_back(1 / ((1 - z * z) * slope * slope));
        }
    }
};

// Not for several threads at once.
inline const GaussRule& gauss_rule(int order) {
    static std::map<int, GaussRule> rules;
    return rules.try_emplace(order, order).first->second;
}

// Calls visit(x, weight) for the points of the rule on [a, b], which crowd towards both ends, so that a
// square root there costs no accuracy.
template <class Visit>
void visit_interval(double a, double b, int order, const Visit& visit) {
    const GaussRule& rule = gauss_rule(order);
    for (size_t i = 0; i < rule.x.size(); ++i) {
        const double u = rule.x[i];
        visit(a + (b - a) * u * u * (3 - 2 * u), rule.weight[i] * (b - a) * 6 * u * (1 - u));
    }
}

// The same on each of the pieces between breaks.front() and breaks.back(); ascending.
template <class Visit>
void visit_pieces(const std::vector<double>& breaks, int order, const Visit& visit) {
    for (size_t i = 0; i + 1 < breaks.size(); ++i)
        if (breaks[i + 1] > breaks[i]) visit_interval(breaks[i], breaks[i + 1], order, visit);
}

}  // namespace candela
