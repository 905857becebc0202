// Unique<Handle, Parent...>: the one owner of a Vulkan handle; it destroys the handle when it goes away.
#pragma once

#include <tuple>
#include <utility>

#include <volk.h>

namespace candela::vk {

// Parent is the argument of the destroy function before the handle: nothing for VkInstance and VkDevice,
// VkDevice for most others. The parent must outlive the handle. Move-only; an empty one holds VK_NULL_HANDLE.
template <class Handle, class... Parent>
class Unique {
  public:
    using Destroy = void(VKAPI_PTR*)(Parent..., Handle, const VkAllocationCallbacks*);

    Unique() = default;
    // Takes ownership of `handle`, which `destroy` (a function of volk's) will destroy.
    Unique(Handle handle, Destroy destroy, Parent... parent)
        : handle_(handle), destroy_(destroy), parent_(parent...) {}
    Unique(Unique&& other) noexcept
        : handle_(std::exchange(other.handle_, Handle{})),
          destroy_(other.destroy_),
          parent_(std::move(other.parent_)) {}
    Unique& operator=(Unique&& other) noexcept {
        std::swap(handle_, other.handle_);
        std::swap(destroy_, other.destroy_);
        std::swap(parent_, other.parent_);
        return *this;
    }
    ~Unique() {
        if (handle_ != Handle{}) {
            std::apply([this](Parent... parent) { destroy_(parent..., handle_, nullptr); }, parent_);
        }
    }

    // The handle, still owned by this object.
    Handle get() const { return handle_; }

  private:
    Handle handle_{};
    Destroy destroy_ = nullptr;
    std::tuple<Parent...> parent_;
};

}  // namespace candela::vk
