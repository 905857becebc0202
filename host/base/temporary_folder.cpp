// See temporary_folder.h.
#include "base/temporary_folder.h"

#include <system_error>

#include "base/error.h"
#include "base/text.h"
#include "os/file.h"
#include "os/mapped_file.h"

namespace candela {

TemporaryFolder::TemporaryFolder(const std::string& user) {
    try {
        path_ = os::make_temporary_folder();
    } catch (const std::system_error& error) {
        throw Error(concat(user, ": cannot create a temporary folder (", error.code().message(), "); set ",
                           os::TEMPORARY_FOLDER_VARIABLE, " to a folder that may be written to"));
    }
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

}  // namespace candela
