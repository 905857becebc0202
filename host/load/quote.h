// Quotes the words of a file in messages.
#pragma once

#include <string>
#include <string_view>

#include "base/file_reach.h"
#include "base/printable.h"

namespace candela {

// `text` in quotation marks, as messages show it: printable, and cut at MAX_NAME_BYTES.
std::string quote(std::string_view text);

// `text` as a whole string of JSON. Bytes that are not UTF-8 become U+FFFD.
std::string json_string(std::string_view text);

// While one lives, messages of its thread do not show the values in a file that another file names: readers
// of the messages may not be allowed to read it. They do show them if the user trusts all files.
class HiddenValues {
  public:
    explicit HiddenValues(const FileReach& reach);
    HiddenValues(const HiddenValues&) = delete;
    HiddenValues& operator=(const HiddenValues&) = delete;
    ~HiddenValues();

  private:
    bool were_hidden_;
};

// A file's value `text` as messages show it, unless values are hidden.
std::string shown(std::string text);

}  // namespace candela
