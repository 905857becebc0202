// Quotes the words of a file in messages.
#pragma once

#include <string>
#include <string_view>

#include "base/file_reach.h"
#include "base/printable.h"

namespace candela {

// `text` in quotation marks, as messages show it: printable, and cut at MOST_NAME_BYTES.
std::string quote(std::string_view text);

// `text` as a whole string of JSON. Bytes that are not UTF-8 become U+FFFD.
std::string json_string(std::string_view text);

// While one lives, messages of its thread do not show the values in a file: it is not the one that the user
// has opened, so that whoever reads the messages might not be meant to read the file. They do if the user
// trusts all files.
class HiddenValues {
  public:
    explicit HiddenValues(const FileReach& reach);
    HiddenValues(const HiddenValues&) = delete;
    HiddenValues& operator=(const HiddenValues&) = delete;
    ~HiddenValues();

  private:
    bool were_hidden_;
};

// What messages show of a file's value, which is `text`: that, unless values are hidden.
std::string shown(std::string text);

}  // namespace candela
