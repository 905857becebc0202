// See caught_error.h.
#include "base/caught_error.h"

#include <exception>
#include <new>
#include <string>

namespace candela {

Error caught_error() {
    try {
        throw;
    } catch (const Error& error) {
        return error;
    } catch (const std::bad_alloc&) {
        return Error("the computer has too little memory; use a smaller picture or scene",
                     ErrorKind::out_of_memory);
    } catch (const std::exception& error) {
        return Error(std::string("unexpected: ") + error.what() + "; this is a bug, please report it");
    }
}

}  // namespace candela
