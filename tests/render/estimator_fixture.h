// What the tests of estimators against each other share.
#pragma once

#include "render_fixture.h"

namespace candela {

class EstimatorTest : public RenderTest {
  protected:
    static constexpr uint32_t SIZE = 64;

    static RenderSettings settings(Estimator estimator, uint32_t seed) {
        RenderSettings s = independent_settings(SIZE, estimator, seed);
        s.max_depth = 8;
        return s;
    }
    Image image(const Scene& scene, const RenderSettings& settings, uint32_t spp) const {
        return image_of(render(scene, settings, spp));
    }
    // Samples per pixel: what each estimator needs for LARGEST_ERROR.
    void expect_estimators_agree(const Scene& scene, uint32_t bsdf_spp, uint32_t spp) const {
        const Image mis = image(scene, settings(Estimator::mis, 1), spp);
        {
            SCOPED_TRACE("light samples only");
            expect_same_expectation(image(scene, settings(Estimator::light, 2), spp), mis);
        }
        SCOPED_TRACE("BSDF samples only");
        expect_same_expectation(image(scene, settings(Estimator::bsdf, 3), bsdf_spp), mis);
    }
};

}  // namespace candela
