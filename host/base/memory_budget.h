// A limit on what one piece of work may allocate, for libraries that believe the numbers in a file.
#pragma once

#include <cstdint>
#include <new>

namespace candela {

// Thrown by `new` instead of exceeding a budget.
class BudgetExceeded : public std::bad_alloc {};

// While one lives, its thread may allocate so many bytes by `new` beyond what it frees. None may live within
// another.
class MemoryBudget {
  public:
    explicit MemoryBudget(uint64_t bytes);
    MemoryBudget(const MemoryBudget&) = delete;
    MemoryBudget& operator=(const MemoryBudget&) = delete;
    ~MemoryBudget();
};

}  // namespace candela
