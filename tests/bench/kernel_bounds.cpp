// See kernel_bounds.h.
#include "kernel_bounds.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/file.h"

namespace candela {
namespace {

using Json = nlohmann::json;

KernelBound read_bound(const Json& json, const std::string& file) {
    if (json.at("why").get<std::string>().empty())
        throw Error(file + ": a bound does not say why: " + json.dump());
    return {.device = json.at("device"),
            .scene = json.at("scene"),
            .kernel = json.at("kernel"),
            .buffers = json.at("buffers"),
            .vgpr_demand = json.at("vgpr_demand")};
}

bool is_for(const KernelBound& bound, const CompiledKernel& kernel) {
    return bound.scene == kernel.scene && bound.kernel == kernel.kernel && bound.buffers == kernel.buffers;
}

// `render (texel buffers) of cornell-box`
std::string title(const std::string& kernel, const std::string& buffers, const std::string& scene) {
    return kernel + (scene.empty() ? "" : " (" + buffers + " buffers) of " + scene);
}

std::string number(double value) {
    return std::to_string(uint64_t(value));
}

// What is wrong with a kernel, whose bound may be missing.
std::vector<std::string> inspect(const CompiledKernel& kernel, const KernelBound* bound,
                                 const std::string& file) {
    std::vector<std::string> complaints;
    const auto limit = [&](const std::string& name, double max, const std::string& remedy) {
        const std::optional<double> value = kernel.find(name);
        if (!value) complaints.push_back("the driver does not tell \"" + name + "\"");
        if (value && *value > max) {
            complaints.push_back("\"" + name + "\" is " + number(*value) + ", the bound is " + number(max) +
                                 "; " + remedy);
        }
    };
    const std::string fewer = "let fewer values be alive at once";
    limit(STATISTIC_SCRATCH, 0, fewer + ", and index no array by variables");
    limit(STATISTIC_SPILLED_VGPRS, 0, fewer);
    if (bound == nullptr) {
        complaints.push_back("it has no bound; give it one in " + file);
    } else {
        limit(STATISTIC_VGPR_DEMAND, bound->vgpr_demand,
              fewer + ", or raise the bound in " + file + " and say why there");
    }
    return complaints;
}

}  // namespace

KernelBounds load_kernel_bounds(const std::filesystem::path& file) {
    const std::string text = read_file(file);
    KernelBounds result{.file = file.string(), .driver = {}, .bounds = {}};
    try {
        const Json json = Json::parse(text);
        result.driver = json.at("driver");
        for (const Json& bound : json.at("bounds"))
            result.bounds.push_back(read_bound(bound, result.file));
    } catch (const Json::exception& error) {
        throw Error(result.file + ": " + error.what());
    }
    return result;
}

std::vector<std::string> find_violations(const KernelBounds& bounds, const std::string& device,
                                         std::span<const CompiledKernel> kernels) {
    std::vector<const KernelBound*> unused;
    for (const KernelBound& bound : bounds.bounds) {
        const bool compiled_so =
            std::ranges::find(kernels, bound.buffers, &CompiledKernel::buffers) != kernels.end();
        if (compiled_so && device.find(bound.device) != std::string::npos) unused.push_back(&bound);
    }
    std::vector<std::string> violations;
    for (const CompiledKernel& kernel : kernels) {
        const auto found =
            std::ranges::find_if(unused, [&](const KernelBound* bound) { return is_for(*bound, kernel); });
        const KernelBound* const bound = found == unused.end() ? nullptr : *found;
        if (bound != nullptr) unused.erase(found);
        for (const std::string& complaint : inspect(kernel, bound, bounds.file)) {
            violations.push_back(title(kernel.kernel, kernel.buffers, kernel.scene) + " on " + device + ": " +
                                 complaint);
        }
    }
    for (const KernelBound* bound : unused) {
        violations.push_back(title(bound->kernel, bound->buffers, bound->scene) + " on " + device +
                             ": no such kernel was compiled; name that scene, or take the bound out of " +
                             bounds.file);
    }
    return violations;
}

}  // namespace candela
