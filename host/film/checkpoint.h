// Checkpoint: the state of a rendering on disk, from which it continues to the same bits.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "base/file.h"
#include "film/accumulation.h"
#include "film/identity.h"

namespace candela {

// Information about the states of a checkpoint.
struct CheckpointHeader {
    Identity identity;
    Maker maker;
    double render_seconds = 0.0;  // Wall time of rendering the states.
    uint32_t planned = 0;         // For adaptive rendering: see render_pass().
};

struct Checkpoint {
    CheckpointHeader header;
    std::vector<Accumulation> states;
};

// Writes a checkpoint to a file, whole or not at all: a multilayer EXR of the states' layers, bit for bit,
// with a checksum. There must be one or four states, all with values. Throws Error if writing fails; the file
// then keeps its old contents.
void save_checkpoint(const std::filesystem::path& path, const CheckpointHeader& header,
                     std::span<const Accumulation> states, FileWriter write = write_file_atomically);

// Reads it back. Throws Error if the file is not a checkpoint, if any significant bit has changed, if it
// holds a state that no renderer produces, or if a newer version wrote it.
Checkpoint load_checkpoint(const std::filesystem::path& path);

// The same for an image that was read; `name` is for messages. Without `with_checksum` the checksum is not
// verified, and a changed bit is found only if it makes a state that no renderer produces.
Checkpoint checkpoint_of(const Image& image, const std::string& name, bool with_checksum = true);

}  // namespace candela
