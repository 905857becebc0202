// See cryptomatte.h.
#include "image/cryptomatte.h"

namespace candela {

std::string crypto_channel(std::string_view layer, uint32_t rank, bool coverage) {
    const uint32_t number = rank / 2, channel = rank % 2 * 2 + (coverage ? 1 : 0);
    return std::string(layer) + char('0' + number / 10) + char('0' + number % 10) + '.' + "RGBA"[channel];
}

std::string crypto_text(uint32_t id) {
    std::string text;
    for (uint32_t shift = 32; shift > 0; shift -= 4)
        text += "0123456789abcdef"[id >> (shift - 4) & 15u];
    return text;
}

std::string crypto_attribute(std::string_view layer, std::string_view name) {
    constexpr size_t DIGITS = 7;  // Of the layer's id; the specification asks for so many.
    return std::string(CRYPTO_PREFIX) + crypto_text(crypto_id(layer)).substr(0, DIGITS) + '/' +
           std::string(name);
}

bool is_crypto_channel(std::string_view name) {
    for (const char* layer : {CRYPTO_OBJECT, CRYPTO_MATERIAL}) {
        for (uint32_t rank = 0; rank < CRYPTO_RANKS; ++rank) {
            if (name == crypto_channel(layer, rank, false) || name == crypto_channel(layer, rank, true))
                return true;
        }
    }
    return false;
}

}  // namespace candela
