// Ctrl-C, termination and the end of the terminal.
#pragma once

#include <memory>
#include <string>

namespace candela::os {

// Determines what they do while it lives. A hang-up that was ignored before, as by nohup, stays ignored. Only
// one may exist at a time.
class Interrupts {
  public:
    // The first is only noted; a second one ends the program at once.
    Interrupts();
    // Each ends the program at once, with this exit code and text on stderr.
    Interrupts(int exit_code, std::string text);
    Interrupts(const Interrupts&) = delete;
    Interrupts& operator=(const Interrupts&) = delete;
    ~Interrupts();

    // Whether one was noted.
    bool noted() const;

  private:
    struct Handlers;
    std::unique_ptr<Handlers> handlers_;
};

}  // namespace candela::os
