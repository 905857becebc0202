// Checkpoint: a rendering on disk, from which it can be continued to the same bits.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "film/accumulation.h"
#include "film/identity.h"

namespace candela {

// What a checkpoint says of the states that it holds.
struct CheckpointHeader {
    Identity identity;
    Maker maker;
    double render_seconds = 0.0;  // Wall time that went into the states.
    uint32_t planned = 0;         // Of an adaptive rendering: see render_pass().
};

struct Checkpoint {
    CheckpointHeader header;
    std::vector<Accumulation> states;
};

// Writes a checkpoint to a file, whole or not at all: a multilayer EXR of the states' layers, bit for bit,
// with a checksum. There are one or four states, and all have values. Throws Error if that fails; the file
// then keeps its old contents.
void save_checkpoint(const std::filesystem::path& path, const CheckpointHeader& header,
                     std::span<const Accumulation> states);

// Reads it back. Throws Error if the file is not a checkpoint, if any bit of it that matters has changed, if
// it holds what no renderer leaves, or if a newer version wrote it.
Checkpoint load_checkpoint(const std::filesystem::path& path);

// The same for an image that was read; `name` is for messages. Without `with_checksum` it is not asked for,
// so that a changed bit is found only where it makes what no renderer leaves.
Checkpoint checkpoint_of(const Image& image, const std::string& name, bool with_checksum = true);

}  // namespace candela
