// Two passes of denoising by variance over a working image, whose layers shared/denoise.h lists: one smooths the
// variance that few samples estimated, the other replaces each pixel by a weighted mean of 5 x 5 pixels some steps
// apart.
// Ref: Dammertz et al., "Edge-Avoiding A-Trous Wavelet Transform for fast Global Illumination Filtering" (2010), section
// 3; weights after Rousselle, Knaus, Zwicker, "Adaptive Rendering with Non-Local Means Filtering" (2012), section 4.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "shared/constants.h"
#include "shared/denoise.h"

layout(local_size_x = WORKGROUP_SIZE, local_size_y = WORKGROUP_SIZE) in;

layout(constant_id = DENOISE_CONSTANT_PASS) const uint PASS = DENOISE_PASS_VARIANCE;

layout(binding = DENOISE_BINDING_IMAGE, rgba32f) uniform image2DArray image;
layout(push_constant) uniform DenoiseBlock {
    DenoisePush push;
};

// Differences of features that reduce a weight to 1/e.
const float NORMAL_SIGMA = 0.3;
const float ALBEDO_SIGMA = 0.1;
// Of the smoothed variance, the share of the neighbours.
const float NEIGHBOURS_SHARE = 0.8;
// A neighbour's variance counts up to this multiple of the pixel's own, or of that of a relative deviation: what is
// beyond lies across an edge that the features do not show, such as a lamp's.
const float VARIANCE_LIMIT = 4.0;
const float RELATIVE_DEVIATION = 0.5;
// Added to variances, in the unit of the squared irradiance: less noise than anyone sees.
const float VARIANCE_FLOOR = 1e-8;

vec4 load(uint layer, ivec2 at) {
    return imageLoad(image, ivec3(at, layer));
}

void store(uint layer, ivec2 at, vec4 value) {
    imageStore(image, ivec3(at, layer), value);
}

bool is_inside(ivec2 at) {
    return all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, ivec2(push.size)));
}

float squared(vec3 v) {
    return dot(v, v);
}

// The negative logarithm of the weight by which a neighbour shows the same surface. Mean normals differ by their own
// noise, too.
float feature_distance(vec4 normal, vec3 albedo, ivec2 neighbour) {
    vec4 other = load(DENOISE_LAYER_NORMAL, neighbour);
    if (normal.a < 0.0 || other.a < 0.0) return 0.0;
    float noise = normal.a + other.a;
    float bend = max(0.0, squared(normal.rgb - other.rgb) - noise) / (NORMAL_SIGMA * NORMAL_SIGMA + noise);
    vec3 difference = albedo - load(DENOISE_LAYER_ALBEDO, neighbour).rgb;
    return bend + squared(difference) / (ALBEDO_SIGMA * ALBEDO_SIGMA);
}

// The mean of the 3 x 3 values around a pixel without the greatest, which may be an outlier; at least its own.
vec3 local_level(ivec2 at, vec3 own) {
    vec3 sum = vec3(0.0), greatest = vec3(0.0);
    float count = 0.0;
    for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
            ivec2 other = at + ivec2(x, y);
            if (!is_inside(other) || load(DENOISE_LAYER_SAMPLED, other).r == DENOISE_MISSING) continue;
            vec3 value = load(DENOISE_LAYER_NOISY, other).rgb;
            sum += min(value, greatest);
            greatest = max(greatest, value);
            count += 1.0;
        }
    }
    return max(own, sum / max(count - 1.0, 1.0));
}

void smooth_variance(ivec2 at) {
    vec3 own = load(DENOISE_LAYER_SAMPLED, at).rgb;
    if (own.r == DENOISE_MISSING) {
        store(DENOISE_LAYER_VARIANCE, at, vec4(vec3(DENOISE_MISSING), 0.0));
        return;
    }
    bool is_known = own.r >= 0.0;
    vec3 value = load(DENOISE_LAYER_NOISY, at).rgb;
    vec4 normal = load(DENOISE_LAYER_NORMAL, at);
    vec3 albedo = load(DENOISE_LAYER_ALBEDO, at).rgb;
    vec3 deviation = RELATIVE_DEVIATION * local_level(at, value);
    vec3 limit = VARIANCE_LIMIT * max(own, deviation * deviation);
    vec3 variance_sum = vec3(0.0), sum = vec3(0.0), square_sum = vec3(0.0);
    float variance_weights = 0.0, weights = 0.0;
    for (int y = -DENOISE_RADIUS; y <= DENOISE_RADIUS; ++y) {
        for (int x = -DENOISE_RADIUS; x <= DENOISE_RADIUS; ++x) {
            ivec2 other = at + ivec2(x, y);
            if (!is_inside(other)) continue;
            vec3 variance = load(DENOISE_LAYER_SAMPLED, other).rgb;
            if (variance.r == DENOISE_MISSING) continue;
            float weight = exp(-feature_distance(normal, albedo, other));
            if (is_known && variance.r >= 0.0) {
                variance_sum += weight * min(variance, limit);
                variance_weights += weight;
            } else if (!is_known) {
                vec3 difference = load(DENOISE_LAYER_NOISY, other).rgb - value;
                sum += weight * difference;
                square_sum += weight * difference * difference;
                weights += weight;
            }
        }
    }
    vec3 smoothed = mix(own, variance_sum / max(variance_weights, VARIANCE_FLOOR), NEIGHBOURS_SHARE);
    if (!is_known) {
        vec3 mean = sum / weights;  // At least 1: the pixel's own.
        smoothed = max(vec3(0.0), square_sum / weights - mean * mean);
    }
    store(DENOISE_LAYER_VARIANCE, at, vec4(smoothed, 1.0));
}

// The negative logarithm of the weight by which two values of the guide have the same expectation: what their variances
// explain of the squared difference is taken off. A neighbour that is much noisier than the pixel has no say in it.
float value_distance(vec3 value, vec3 variance, vec3 other_value, vec3 other_variance) {
    vec3 difference = value - other_value;
    vec3 excess = max(vec3(0.0), difference * difference - variance - min(variance, other_variance));
    vec3 expected = push.tolerance * (variance + min(other_variance, push.outlier * variance)) + VARIANCE_FLOOR;
    return dot(excess / expected, vec3(1.0 / 3.0));
}

// Coefficients of the cubic B-spline.
float spline(int step) {
    return step == 0 ? 0.375 : abs(step) == 1 ? 0.25 : 0.0625;
}

void filter_image(ivec2 at) {
    vec4 normal = load(DENOISE_LAYER_NORMAL, at);
    vec3 albedo = load(DENOISE_LAYER_ALBEDO, at).rgb;
    vec3 value = load(push.guide, at).rgb;
    vec3 variance = load(push.guide + 1u, at).rgb;
    float own_weight = 0.0, weights = 0.0;
    vec4 sum = vec4(0.0);
    vec3 variance_sum = vec3(0.0);
    for (int y = -DENOISE_RADIUS; y <= DENOISE_RADIUS; ++y) {
        for (int x = -DENOISE_RADIUS; x <= DENOISE_RADIUS; ++x) {
            ivec2 other = at + ivec2(x, y) * int(push.step);
            if (!is_inside(other)) continue;
            vec4 source_variance = load(push.source + 1u, other);
            if (source_variance.r == DENOISE_MISSING) continue;
            float weight = spline(x) * spline(y);
            if (x == 0 && y == 0) {
                own_weight = weight * source_variance.a;
            } else {
                float d = feature_distance(normal, albedo, other);
                vec3 other_variance = load(push.guide + 1u, other).rgb;
                if (variance.r != DENOISE_MISSING && other_variance.r != DENOISE_MISSING)
                    d += value_distance(value, variance, load(push.guide, other).rgb, other_variance);
                weight *= exp(-d);
            }
            weights += weight;
            sum += weight * load(push.source, other);
            variance_sum += weight * weight * source_variance.rgb;
        }
    }
    // Nothing has a value near a pixel without one, or nothing shows its surface.
    if (weights == 0.0) {
        store(push.target, at, load(push.source, at));
        store(push.target + 1u, at, vec4(vec3(DENOISE_MISSING), 0.0));
        return;
    }
    store(push.target, at, sum / weights);
    store(push.target + 1u, at, vec4(variance_sum / (weights * weights), own_weight / weights));
}

void main() {
    if (any(greaterThanEqual(gl_GlobalInvocationID.xy, push.count))) return;
    ivec2 at = ivec2(push.origin + gl_GlobalInvocationID.xy);
    if (PASS == DENOISE_PASS_VARIANCE) {
        smooth_variance(at);
    } else {
        filter_image(at);
    }
}
