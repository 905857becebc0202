// Attempts: several things to do of which none shall keep the others from being tried.
#pragma once

#include <functional>
#include <optional>

#include "base/error.h"
#include "cli/console.h"

namespace candela {

// Tries one thing after another; in the end throws the last Error, after the others have been printed.
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
    void finish() const {
        if (failure_) throw Error(*failure_);
    }

  private:
    std::optional<Error> failure_;
};

}  // namespace candela
