// PartSum: the arithmetic of `candela merge`, which turns images of different samples of the same pixels into
// the image of all samples.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "image/image.h"

namespace candela {

// Sums, in double precision, of images that differ only in their samples. The values of the images are
// rounded to floats (u = 2^-24); the rounding of the doubles here is negligible. So the mean of non-negative
// values has a relative error of at most 2 u, u for the parts and u for the result; and it is within 3 u of
// an image of all samples, which is rounded, too. For values of both signs (N) these errors are relative to
// the mean of |part|.
//
// The sum of squared deviations of all N samples, N (N - 1) V for the Variance V, consists of the sum within
// the parts, n (n - 1) Variance, and the sum between them, w d^2, where d is the difference between a part's
// mean and the mean of the parts before it, and w < n. In real numbers this is exact. With rounding, the
// former has a relative error of u. The d are off by e <= 2 u M, for means up to M, and by Cauchy and Schwarz
// the sum of w (2 d e + e^2) is at most 4 u M sqrt(N sum(w d^2)) + 4 u^2 M^2 N. With one more u for the
// result, V is off by less than 3 u V + 4 u M sqrt(V / (N - 1)) + 4 u^2 M^2 / (N - 1).
//
// Ref: Chan, Golub, LeVeque, "Algorithms for Computing the Sample Variance" (1983), equation 2.1.
class PartSum {
  public:
    // For images of the size of `like`; sums their channels of these names, in this order. It knows R, G, B,
    // A, Albedo, N and the layers of guides and catchers (means), variances of R, G and B and of the guides'
    // albedo, SampleCount.V, and what is_constant().
    PartSum(const Image& like, std::vector<std::string> channels);
    static bool knows(const std::string& channel);
    // Whether the channel depends on no sample, and is the same in all images.
    static bool is_constant(const std::string& channel);
    // The channels of the means whose variance it is, added up; none for other channels.
    static std::vector<std::string> means_of(const std::string& channel);

    // Adds an image with counts[i] samples of pixel i. It must have all the channels and their means_of().
    void add(const Image& part, const std::vector<uint32_t>& counts);

    // The image of all samples, in 32 bits, without attributes. Means are 0 for pixels without samples, and
    // Variance is infinite below two samples.
    Image image() const;

    const std::vector<uint64_t>& counts() const { return counts_; }

  private:
    enum class Kind { mean, variance, count, constant };
    struct Sum {
        std::string name;
        Kind kind;
        std::vector<double> values;  // mean: sum of the samples; variance: sum of squared deviations.
        std::vector<std::vector<double>> samples;  // variance: sums of the samples, for each of means_of().
    };
    static Kind kind_of(const std::string& channel);
    void add_mean(Sum& sum, const Channel& channel, const std::vector<uint32_t>& counts) const;
    void add_variance(Sum& sum, const Image& part, const std::vector<uint32_t>& counts) const;

    uvec2 full_;
    PixelRect data_;
    std::vector<uint64_t> counts_;  // Samples of the images so far.
    std::vector<Sum> sums_;
};

}  // namespace candela
