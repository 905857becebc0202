// See screen_options.h.
#include "cli/screen_options.h"

#include <charconv>
#include <utility>
#include <variant>
#include <vector>

#include "base/color.h"
#include "base/file.h"
#include "base/memory_limit.h"
#include "cli/arguments.h"
#include "cli/console.h"
#include "image/texel_io.h"
#include "session/picture_file.h"

namespace candela {
namespace {

constexpr const char* TRANSPARENT = "transparent";

constexpr Choices<AlphaConvention, 2> ALPHA_NAMES{
    {{"transmission", AlphaConvention::transmission}, {"first-hit", AlphaConvention::first_hit}}};
constexpr Choices<TexelType, 2> BITS_NAMES{{{"8", TexelType::unorm8}, {"16", TexelType::unorm16}}};

// The light of a colour `#rrggbb` of sRGB.
std::optional<vec3> parse_colour(const std::string& text) {
    uint32_t number = 0;
    const char* const end = text.data() + text.size();
    if (text.size() != 7 || text[0] != '#') return std::nullopt;
    const auto [stop, error] = std::from_chars(text.data() + 1, end, number, 16);
    if (error != std::errc() || stop != end) return std::nullopt;
    const auto light = [number](int shift) { return srgb_decode(float(number >> shift & 0xFFu) / 255.0f); };
    return vec3(light(16), light(8), light(0));
}

// A file's name cannot begin with #, unless it has a folder in front.
std::optional<std::string> parse_background(const std::string& text) {
    if (text.empty() || (text[0] == '#' && !parse_colour(text))) return std::nullopt;
    return text;
}

TexelImage load_image(const std::string& file) {
    const LimitedMemory limited;
    std::vector<std::string> warnings;
    TexelImage image = with_memory_for(
        "the background", [&] { return file; },
        [&] { return decode_texels(read_file(file), file, warnings); });
    print_warnings(warnings);
    return image;
}

}  // namespace

void ScreenOptions::add_to(CLI::App& app) {
    add_value(app, "--background", background, parse_background, "transparent, #rrggbb or an image file",
              "Put pictures before nothing, a colour (in quotes: '#rrggbb') or an image, instead of the sky; "
              "EXR files hold them before nothing")
        ->type_name("BACKGROUND");
    add_choice(app, "--bits", type, BITS_NAMES, "PNG: bits of a channel (default: 8)");
    add_value(
        app, "--quality", quality, [](const std::string& text) { return parse_uint(text, 1, 100); },
        "a whole number from 1 to 100", "JPEG and WebP: quality (default: 90)")
        ->type_name("Q");
}

void ScreenOptions::add_alpha_to(CLI::App& app) {
    add_choice(app, "--alpha", alpha, ALPHA_NAMES,
               "Whether the background is seen through glass (default: transmission), or hidden by "
               "whatever a camera ray hits first")
        ->needs(app.get_option("--background"));
}

std::optional<std::string> ScreenOptions::background_file() const {
    if (!background || *background == TRANSPARENT || parse_colour(*background)) return std::nullopt;
    return background;
}

void ScreenOptions::load() {
    if (!background) return;
    if (*background == TRANSPARENT) {
        loaded = std::make_shared<const Background>(Transparent{});
    } else if (const std::optional<vec3> colour = parse_colour(*background)) {
        loaded = std::make_shared<const Background>(*colour);
    } else {
        loaded = std::make_shared<const Background>(load_image(*background));
    }
}

Backdrop ScreenOptions::backdrop() const {
    if (!background) return Backdrop::environment;
    return alpha == AlphaConvention::first_hit ? Backdrop::background : Backdrop::transmitted;
}

TexelImage ScreenOptions::develop(const Image& image, ImageFormat format, Tonemap curve,
                                  float exposure_ev) const {
    return candela::develop(image, {.curve = curve,
                                    .exposure_ev = exposure_ev,
                                    .type = format == ImageFormat::png ? type : TexelType::unorm8,
                                    .background = loaded ? loaded.get() : default_background(image)});
}

PictureNotes ScreenOptions::notes(const Image& image) const {
    PictureNotes notes = picture_notes(image);
    notes.quality = quality;
    return notes;
}

}  // namespace candela
