// See private_file.h.
#include "base/private_file.h"

#include <system_error>

#include "base/temporary_file.h"
#include "os/file.h"

namespace candela {

namespace fs = std::filesystem;

std::optional<std::string> read_private_file(const fs::path& folder, const std::string& name, size_t max) {
    const os::PrivateFolder there(folder);
    return there.exists() ? there.read(name, max) : std::nullopt;
}

void write_private_file(const fs::path& folder, const std::string& name, std::string_view bytes) {
    const os::PrivateFolder there(folder, true);
    if (!there.exists()) return;
    const fs::path target = there.path() / name;
    std::error_code error;
    const fs::file_type old = fs::symlink_status(target, error).type();
    if (old != fs::file_type::regular && old != fs::file_type::not_found) return;
    remove_abandoned_files(there.path());
    TemporaryFile file(target, os::OWNER_ONLY);
    file.write(bytes);
    file.flush();
    file.commit();
}

}  // namespace candela
