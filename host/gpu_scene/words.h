// Words of records, which do not change once they are there. Copies share them.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "base/math.h"

namespace candela {

class Words {
  public:
    Words() = default;
    Words(std::vector<uvec4> words) : words_(std::make_shared<const std::vector<uvec4>>(std::move(words))) {}

    operator const std::vector<uvec4>&() const { return *words_; }
    const uvec4* data() const { return words_->data(); }
    const uvec4* begin() const { return data(); }
    const uvec4* end() const { return data() + size(); }
    size_t size() const { return words_->size(); }
    bool empty() const { return words_->empty(); }
    const uvec4& operator[](size_t i) const { return (*words_)[i]; }

    bool operator==(const Words& other) const { return is(other) || *words_ == *other.words_; }
    // Whether both are copies of one object, so that their words need not be compared.
    bool is(const Words& other) const { return words_ == other.words_; }

  private:
    std::shared_ptr<const std::vector<uvec4>> words_ = std::make_shared<const std::vector<uvec4>>();
};

}  // namespace candela
