// Cuts a stream of bytes into lines, of a limited length.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace candela::serve {

class LineReader {
  public:
    // `max`: the most bytes of a line, without its end.
    explicit LineReader(size_t max) : max_(max) {}

    // The bytes that follow.
    void add(std::string_view bytes);
    // The next line, without its end; nothing as long as none is whole. Throws RequestError once for a line
    // that is too long, which is then skipped.
    std::optional<std::string> next();
    // Throws RequestError if the bytes ended within a line.
    void finish() const;

  private:
    void drop_lines();

    size_t max_;
    std::string bytes_;
    size_t begin_ = 0;          // Where the next line begins,
    size_t searched_ = 0;       // and where its end is still to be looked for.
    bool is_skipping_ = false;  // Until the end of a line that was too long.
};

}  // namespace candela::serve
