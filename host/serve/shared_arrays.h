// The arrays of a request, in memory that its client shares.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "load/node.h"
#include "scene/named_arrays.h"
#include "serve/shared_memory.h"

namespace candela::serve {

class SharedArrays : public NamedArrays {
  public:
    // Reads the parameter `arrays`: by name, the file, the offset in it [bytes], the type and the shape of
    // each. Throws Error if one is not there, or shorter than that.
    explicit SharedArrays(const Node& arrays);

    // The least memory that a scene with all of them needs [bytes].
    uint64_t needed() const;

    std::vector<std::string> names() const override;
    const NamedArray* find(const std::string& name) const override;
    void read(const std::string& name, uint64_t offset, std::span<std::byte> bytes) const override;

  private:
    struct Placed {
        NamedArray array;
        std::shared_ptr<const SharedFile> file;
        uint64_t offset = 0;
    };
    std::map<std::string, Placed> arrays_;
};

}  // namespace candela::serve
