// See light_groups.h.
#include "gpu_scene/light_groups.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "gpu_scene/alias_table.h"
#include "gpu_scene/punctual_lights.h"

namespace candela {
namespace {

constexpr uint32_t WHOLE = 1u << 31u;  // 1, in the unit of LightGroups' fractions.

double sum(std::span<const double> powers) {
    return std::accumulate(powers.begin(), powers.end(), 0.0);
}

// The fraction for a group with that power, out of what is left for it and the other groups; at least 1, and
// it leaves at least 1 for each of them.
uint32_t fraction(double power, double others_power, uint32_t left, uint32_t others) {
    if (power == 0.0) return 0;
    if (others == 0) return left;
    const auto part = uint32_t(std::floor(double(left) * (power / (power + others_power)) + 0.5));
    return std::clamp(part, 1u, left - others);
}

int rank(const LightRecord& light) {
    return light.kind == LIGHT_ENVIRONMENT ? 2 : is_afar(light) ? 1 : 0;
}

// Sorts lights and their powers by rank, keeping the order of equal ones.
void sort_by_rank(PoweredLights& lights) {
    std::vector<uint32_t> order(lights.records.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::stable_sort(order, {}, [&](uint32_t i) { return rank(lights.records[i]); });
    PoweredLights sorted;
    for (const uint32_t i : order) {
        sorted.records.push_back(lights.records[i]);
        sorted.powers.push_back(lights.powers[i]);
    }
    lights = std::move(sorted);
}

}  // namespace

LightGroups group_lights(PoweredLights& lights) {
    if (!std::ranges::is_sorted(lights.records, {}, rank)) sort_by_rank(lights);
    const auto count = [&](int of_rank) {
        return uint32_t(std::ranges::count(lights.records, of_rank, rank));
    };
    LightGroups groups{};
    groups.placed = count(0);
    groups.suns = count(1);
    const std::span<const double> powers = lights.powers;
    const double placed = sum(powers.first(groups.placed));
    const double suns = sum(powers.subspan(groups.placed, groups.suns));
    const double sky = sum(powers.subspan(groups.placed + groups.suns));
    const uint32_t any_placed = groups.placed > 0, any_suns = groups.suns > 0;
    groups.sky_fraction = fraction(sky, suns + placed, WHOLE, any_suns + any_placed);
    groups.sun_fraction = fraction(suns, placed, WHOLE - groups.sky_fraction, any_placed);
    for (uint32_t i = 0; i < lights.records.size(); ++i) {
        LightRecord& light = lights.records[i];
        uint32_t group_fraction = WHOLE - groups.sun_fraction - groups.sky_fraction;
        double group_power = placed;
        if (rank(light) == 1) {
            group_fraction = groups.sun_fraction;
            group_power = suns;
        } else if (rank(light) == 2) {
            group_fraction = groups.sky_fraction;
            group_power = sky;
        }
        light.pmf = float(powers[i] / group_power * (double(group_fraction) / WHOLE));
    }
    return groups;
}

std::vector<AliasEntry> light_alias_tables(const LightGroups& groups, std::span<const double> powers) {
    std::vector<AliasEntry> tables;
    for (const std::span<const double> group :
         {powers.first(groups.placed), powers.subspan(groups.placed, groups.suns)}) {
        if (group.empty()) continue;
        const std::vector<AliasEntry> table = build_alias_table(group);
        tables.insert(tables.end(), table.begin(), table.end());
    }
    return tables;
}

}  // namespace candela
