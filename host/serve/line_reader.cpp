// See line_reader.h.
#include "serve/line_reader.h"

#include "base/text.h"
#include "serve/message.h"

namespace candela::serve {

void LineReader::add(std::string_view bytes) {
    if (is_skipping_) {
        const size_t end = bytes.find('\n');
        if (end == std::string_view::npos) return;
        bytes.remove_prefix(end + 1);
        is_skipping_ = false;
    }
    drop_lines();
    bytes_ += bytes;
}

// Forgets what has been read, and the memory of a long line.
void LineReader::drop_lines() {
    if (begin_ == 0) return;
    bytes_.substr(begin_).swap(bytes_);  // An assignment would keep the memory.
    searched_ -= begin_;
    begin_ = 0;
}

std::optional<std::string> LineReader::next() {
    const size_t found = bytes_.find('\n', searched_);
    const bool is_whole = found != std::string::npos;
    const size_t end = is_whole ? found : bytes_.size();
    searched_ = end;
    if (!is_whole && end - begin_ <= max_) return std::nullopt;
    std::string line = end - begin_ <= max_ ? bytes_.substr(begin_, end - begin_) : "";
    const bool is_too_long = end - begin_ > max_;
    begin_ = searched_ = is_whole ? end + 1 : end;
    if (begin_ == bytes_.size()) drop_lines();
    if (!is_too_long) return line;
    is_skipping_ = !is_whole;
    throw RequestError(Code::invalid_request,
                       concat("request: a line has more than ", max_, " bytes; send less, or name a file"));
}

void LineReader::finish() const {
    if (begin_ < bytes_.size() || is_skipping_)
        throw RequestError(Code::not_json, "request: the messages end in the middle of a line");
}

}  // namespace candela::serve
