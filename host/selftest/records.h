// Tests that the device unpacks the records that the host packs.
#pragma once

#include "render/renderer.h"
#include "selftest/evidence.h"
#include "vk/device.h"

namespace candela {

// Every field of a filled record of each kind must arrive, bit for bit. `access` is not `automatic`.
Evidence test_records(const vk::Device& device, SceneAccess access);

// Packed normals must keep their direction.
Evidence test_octahedral_normals(const vk::Device& device);

}  // namespace candela
