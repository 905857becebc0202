// Checkpoint: a rendering on disk, from which it can be continued to the same bits.
#pragma once

#include <filesystem>
#include <string>

#include "render/accumulation.h"
#include "render/identity.h"

namespace candela {

struct Checkpoint {
    Identity identity;
    Maker maker;
    double render_seconds = 0.0;  // Wall time that went into the state.
    Accumulation state;
};

// Writes a checkpoint to a file, whole or not at all: a multilayer EXR of the state's layers, bit for bit,
// with a checksum. Throws Error if that fails; the file then keeps its old contents.
void save_checkpoint(const std::filesystem::path& path, const Identity& identity, const Maker& maker,
                     double render_seconds, const Accumulation& state);

// Reads it back. Throws Error if the file is not a checkpoint, or if any bit of it that matters has changed.
Checkpoint load_checkpoint(const std::filesystem::path& path);

}  // namespace candela
