// Libraries that are loaded while the program runs.
#pragma once

#include <filesystem>
#include <string>

namespace candela::os {

// The name of a library's file: "libNAME.so.2" for a name and a major version of its interface.
std::string library_file(const std::string& name, int version);

class Library {
  public:
    // A name without a folder is looked for where the system has its libraries. If it cannot be loaded,
    // error() says why. It stays in memory when this ends, for threads that it started.
    explicit Library(const std::filesystem::path& file);

    bool is_loaded() const { return handle_ != nullptr; }
    const std::string& error() const { return error_; }
    // The function of that name; nullptr if there is none.
    template <class Function>
    Function* find(const char* name) const {
        return reinterpret_cast<Function*>(address_of(name));
    }

  private:
    void* address_of(const char* name) const;

    void* handle_ = nullptr;
    std::string error_;
};

}  // namespace candela::os
