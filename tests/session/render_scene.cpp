// A program that links candela_session alone: renders a scene, looks at it from elsewhere, and goes back.
// Prints the hash of the first picture as reports of candela render have it, and fails unless the last
// picture has the same bits and the other one has not.
//
// usage: render_scene SCENE CAMERAS BACK      CAMERAS, BACK: JSON for Session::change()
#include <cinttypes>
#include <cstdio>
#include <cstring>
#include <exception>
#include <stdexcept>
#include <string>

#include "session/session.h"

// FNV-1a of R, G, B, pixel by pixel.
static uint64_t hash_of(const candela::Session& session) {
    const auto layers = session.layers();
    uint64_t hash = 0xcbf29ce484222325;
    for (size_t i = 0; i < size_t{session.width()} * session.height(); ++i) {
        for (const char* name : {"R", "G", "B"}) {
            for (const candela::PictureLayer& layer : layers) {
                unsigned char bytes[sizeof(float)];
                if (layer.name != name) continue;
                std::memcpy(bytes, &layer.values[i], sizeof bytes);
                for (const unsigned char byte : bytes)
                    hash = (hash ^ byte) * 0x100000001b3;
            }
        }
    }
    return hash;
}

int main(int argc, char** argv) try {
    if (argc != 4) return 2;
    candela::Session session(
        {.warn = [](const std::string& what) { throw std::runtime_error(what); }, .validation = true});
    session.load({.path = argv[1]});
    session.choose({.width = 32, .height = 24});
    session.render(2);
    session.render(4);
    const uint64_t first = hash_of(session);
    session.change(argv[2]);
    session.render(4);
    const uint64_t other = hash_of(session);
    session.change(argv[3]);
    session.render(4);
    std::printf("%016" PRIx64 "\n", first);
    return first != other && first == hash_of(session) ? 0 : 1;
} catch (const std::exception& error) {
    std::fprintf(stderr, "render_scene: %s\n", error.what());
    return 1;
}
