// See temporary_folder.h.
#include "base/temporary_folder.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <system_error>

#include "base/error.h"
#include "base/text.h"

namespace candela {

TemporaryFolder::TemporaryFolder(const std::string& user) {
    std::error_code no_folder;
    std::string name = (std::filesystem::temp_directory_path(no_folder) / "candela-XXXXXX").string();
    if (no_folder || ::mkdtemp(name.data()) == nullptr) {
        throw Error(concat(user, ": cannot create a temporary folder (",
                           no_folder ? no_folder.message() : std::string(std::strerror(errno)),
                           "); set TMPDIR to a folder that may be written to"));
    }
    path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

}  // namespace candela
