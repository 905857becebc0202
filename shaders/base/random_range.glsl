// A random number for several choices in a row: the unused randomness of each is uniform, and decides the next. Like an
// arithmetic decoder, it divides ranges of whole numbers, so that no bit is lost. The first bits, which a sampler may
// have spread evenly, decide first; bits of `more` follow.
#ifndef BASE_RANDOM_RANGE_GLSL
#define BASE_RANDOM_RANGE_GLSL

// Parts into which a choice divides the whole.
const uint RANGE_PARTS = 32768u;

struct RandomRange {
    uint u;     // Uniform in 0 .. size - 1.
    uint size;  // At least 2^30 and below 2^31.
    uint more;  // The next random bits, the highest first.
};

// From 2 x 32 random bits, those of x first.
RandomRange range_begin(uvec2 bits) {
    return RandomRange(bits.x >> 2u, 1u << 30u, bits.x << 30u | bits.y >> 2u);
}

// Refills a range, whose size is above 0, to at least 2^30.
void range_refill(inout RandomRange r) {
    int shift = 30 - findMSB(r.size);
    r.size <<= shift;
    r.u = r.u << shift | r.more >> 1u >> (31 - shift);
    r.more = r.more * 747796405u + 2891336453u;
}

// The probability of part c of four with these ends.
float range_part(uvec4 ends, uint c) {
    uint begin = c == 0u ? 0u : c == 1u ? ends.x : c == 2u ? ends.y : ends.z;
    uint end = c == 0u ? ends.x : c == 1u ? ends.y : c == 2u ? ends.z : ends.w;
    return float(end - begin) * (1.0 / float(RANGE_PARTS));
}

// Chooses one of four parts with these ends, in units of 1 / RANGE_PARTS; the last one ends at 1. Probabilities are
// right within 2^-30.
uint range_choose(inout RandomRange r, uvec4 ends) {
    uvec3 split, low;
    umulExtended(uvec3(2u * r.size), ends.xyz << 16u, split, low);  // size * ends / RANGE_PARTS, without overflow.
    uint begin = 0u, end = r.size, chosen = 0u;
    if (r.u >= split.x) begin = split.x, chosen = 1u;
    if (r.u >= split.y) begin = split.y, chosen = 2u;
    if (r.u >= split.z) begin = split.z, chosen = 3u;
    end = chosen == 0u ? split.x : chosen == 1u ? split.y : chosen == 2u ? split.z : r.size;
    r.u -= begin;
    r.size = end - begin;
    range_refill(r);
    return chosen;
}

#endif
