// Replaces the operators new and delete of the program and of the C++ libraries that it loads.
#include "base/memory_limit.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string_view>

#include "base/memory_budget.h"
#include "base/parse_float.h"
#include "base/text.h"
#include "os/memory.h"

namespace candela {
namespace {

constexpr uint64_t NO_LIMIT = UINT64_MAX;
// The reserve for error messages when memory is used up, and the largest size of its parts.
constexpr uint64_t RESERVE = uint64_t(1) << 20;
constexpr size_t SMALL = 1024;

std::atomic<uint64_t> in_use = 0;
std::atomic<uint64_t> limit = NO_LIMIT;
thread_local uint32_t holders = 0;  // This thread's live objects of LimitedMemory.
// Bytes left of this thread's MemoryBudget, if it has one.
thread_local int64_t budget = 0;
thread_local bool has_budget = false;

void check_limit(uint64_t bytes) {
    if (has_budget && (budget < 0 || bytes > uint64_t(budget))) throw BudgetExceeded();
    if (holders == 0) return;
    const uint64_t used = in_use.load(std::memory_order_relaxed);
    const uint64_t max = limit.load(std::memory_order_relaxed);
    if (max == NO_LIMIT || used + bytes <= max) return;
    if (bytes > SMALL || used + bytes > max + RESERVE) throw LimitReached(bytes, used);
}

void add_use(size_t size) {
    in_use.fetch_add(size, std::memory_order_relaxed);
    if (has_budget) budget -= int64_t(size);
}

void end_use(size_t size) {
    in_use.fetch_sub(size, std::memory_order_relaxed);
    if (has_budget) budget += int64_t(size);
}

void* allocate(size_t size) {
    check_limit(size);
    void* const memory = os::allocate(std::max<size_t>(size, 1));
    if (memory == nullptr) throw std::bad_alloc();
    add_use(os::size_of(memory));
    return memory;
}

void* allocate(size_t size, std::align_val_t alignment) {
    check_limit(size);
    void* const memory = os::allocate_aligned(std::max<size_t>(size, 1), size_t(alignment));
    if (memory == nullptr) throw std::bad_alloc();
    add_use(os::size_of_aligned(memory));
    return memory;
}

void release(void* memory) {
    if (memory == nullptr) return;
    end_use(os::size_of(memory));
    os::release(memory);
}

void release_aligned(void* memory) {
    if (memory == nullptr) return;
    end_use(os::size_of_aligned(memory));
    os::release_aligned(memory);
}

std::string size_text(uint64_t bytes) {
    constexpr uint64_t GIBI = uint64_t(1) << 30;
    const bool large = bytes >= GIBI;
    return number_text(double(bytes) / double(large ? GIBI : GIBI >> 10), 3) + (large ? " GiB" : " MiB");
}

}  // namespace

uint64_t memory_in_use() {
    return in_use.load(std::memory_order_relaxed);
}

void set_memory_limit(uint64_t bytes) {
    limit = bytes;
}

uint64_t memory_limit() {
    return limit;
}

uint64_t default_memory_limit() {
    return os::allowed_memory() / 4 * 3;
}

std::optional<uint64_t> parse_memory_size(const std::string& text) {
    double number = 0.0;
    const auto [end, error] = parse_float(text.data(), text.data() + text.size(), number);
    std::string unit(end, text.data() + text.size());
    if (error != std::errc()) return std::nullopt;
    double factor = 1.0;
    if (!unit.empty()) {
        constexpr std::string_view PREFIXES = "kMGT";
        const size_t prefix = PREFIXES.find(unit[0] == 'K' ? 'k' : unit[0]);
        unit.erase(0, 1);
        if (prefix == std::string_view::npos || (!unit.empty() && unit != "B" && unit != "iB"))
            return std::nullopt;
        factor = std::pow(unit == "iB" ? 1024.0 : 1000.0, double(prefix) + 1.0);
    }
    const double bytes = std::floor(number * factor);
    if (!(bytes >= 1.0 && bytes <= 0x1p63)) return std::nullopt;
    return uint64_t(bytes);
}

LimitedMemory::LimitedMemory() {
    ++holders;
}

LimitedMemory::~LimitedMemory() {
    --holders;
}

bool LimitedMemory::applies() {
    return holders > 0;
}

MemoryBudget::MemoryBudget(uint64_t bytes) {
    budget = int64_t(std::min(bytes, uint64_t(INT64_MAX)));
    has_budget = true;
}

MemoryBudget::~MemoryBudget() {
    has_budget = false;
}

MemoryCharge::MemoryCharge(uint64_t bytes) : bytes_(bytes) {
    check_limit(bytes);
    in_use += bytes;
}

MemoryCharge::~MemoryCharge() {
    in_use -= bytes_;
}

std::string shortage_text(const std::bad_alloc& error, uint64_t before) {
    const auto* reached = dynamic_cast<const LimitReached*>(&error);
    if (reached == nullptr) return "";
    const uint64_t needed = std::max(reached->needed(), before);
    return ", which needs at least " + size_text(needed - before) + ", where " + size_text(before) +
           " are in use and --memory-limit allows " + size_text(limit);
}

}  // namespace candela

// All forms, since sanitizers replace the missing ones with their own. If these are inlined, GCC warns that
// malloc() and delete do not match.
[[gnu::noinline]] void* operator new(size_t size) {
    return candela::allocate(size);
}

[[gnu::noinline]] void* operator new(size_t size, std::align_val_t alignment) {
    return candela::allocate(size, alignment);
}

[[gnu::noinline]] void* operator new(size_t size, const std::nothrow_t&) noexcept {
    try {
        return ::operator new(size);
    } catch (const std::bad_alloc&) {
        return nullptr;
    }
}

[[gnu::noinline]] void* operator new[](size_t size) {
    return ::operator new(size);
}

[[gnu::noinline]] void* operator new[](size_t size, std::align_val_t alignment) {
    return ::operator new(size, alignment);
}

[[gnu::noinline]] void* operator new[](size_t size, const std::nothrow_t& nothrow) noexcept {
    return ::operator new(size, nothrow);
}

[[gnu::noinline]] void operator delete(void* memory) noexcept {
    candela::release(memory);
}

[[gnu::noinline]] void operator delete(void* memory, size_t) noexcept {
    candela::release(memory);
}

[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept {
    candela::release_aligned(memory);
}

[[gnu::noinline]] void operator delete(void* memory, size_t, std::align_val_t) noexcept {
    candela::release_aligned(memory);
}

[[gnu::noinline]] void operator delete[](void* memory) noexcept {
    candela::release(memory);
}

[[gnu::noinline]] void operator delete[](void* memory, size_t) noexcept {
    candela::release(memory);
}

[[gnu::noinline]] void operator delete[](void* memory, std::align_val_t) noexcept {
    candela::release_aligned(memory);
}

[[gnu::noinline]] void operator delete[](void* memory, size_t, std::align_val_t) noexcept {
    candela::release_aligned(memory);
}
