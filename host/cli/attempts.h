// Attempts: several actions, all of which are tried even if some fail.
#pragma once

#include <functional>
#include <optional>

#include "base/error.h"
#include "cli/console.h"

namespace candela {

// Tries one action after another; at the end prints all Errors but the last, and throws that.
class Attempts {
  public:
    void attempt(const std::function<void()>& action) {
        try {
            action();
        } catch (const Error& error) {
            if (failure_) print_error(failure_->what());
            failure_ = error;
        }
    }
    // The last Error so far.
    const std::optional<Error>& failure() const { return failure_; }
    void finish() const {
        if (failure_) throw Error(*failure_);
    }

  private:
    std::optional<Error> failure_;
};

}  // namespace candela
