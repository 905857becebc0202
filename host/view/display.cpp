// See display.h.
#include "view/display.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "render/kernels.h"
#include "shared/constants.h"
#include "shared/display.h"
#include "vk/transfer.h"

namespace candela {
namespace {

constexpr std::array BINDINGS{vk::Binding{DISPLAY_BINDING_IMAGE, vk::BindingType::storage_image},
                              vk::Binding{DISPLAY_BINDING_OVERLAY, vk::BindingType::storage_buffer},
                              vk::Binding{DISPLAY_BINDING_PICTURE, vk::BindingType::storage_buffer},
                              vk::Binding{DISPLAY_BINDING_SCREEN, vk::BindingType::storage_buffer}};

uint32_t curve_constant(Tonemap curve) {
    switch (curve) {
        case Tonemap::linear:
            return TONEMAP_LINEAR;
        case Tonemap::reinhard:
            return TONEMAP_REINHARD;
        case Tonemap::aces:
            return TONEMAP_ACES;
        case Tonemap::agx:
            return TONEMAP_AGX;
        case Tonemap::neutral:
            break;
    }
    return TONEMAP_NEUTRAL;
}

}  // namespace

vk::Kernel make_display_kernel(const vk::Device& device, Tonemap curve, bool blue_first) {
    std::array<uint32_t, DISPLAY_CONSTANT_COUNT> constants{};
    constants[DISPLAY_CONSTANT_CURVE] = curve_constant(curve);
    constants[DISPLAY_CONSTANT_BLUE_FIRST] = blue_first;
    return {device, kernels::display, BINDINGS, sizeof(DisplayPush), constants, "display"};
}

Display::Display(const vk::Device& device, bool blue_first)
    : device_(&device), blue_first_(blue_first), commands_(device) {}

void Display::resize(uvec2 size) {
    const uint64_t bytes = uint64_t{size.x} * size.y * sizeof(uint32_t);
    overlay_ = std::make_unique<vk::Buffer>(*device_, bytes, vk::BufferUsage::readback, "overlay");
    picture_ = std::make_unique<vk::Buffer>(*device_, bytes, vk::BufferUsage::storage, "picture");
    screen_ = std::make_unique<vk::Buffer>(*device_, bytes, vk::BufferUsage::storage, "screen");
    vk::upload(*picture_, std::vector<std::byte>(bytes));
    size_ = size;
}

void Display::draw(const vk::StorageImage& image, uvec2 size, Tonemap curve, float exposure_ev,
                   const Overlay& overlay) {
    assert(size.x > 0 && size.y > 0);
    assert(overlay.rect.x1 <= size.x && overlay.rect.y1 <= size.y);
    if (size != size_) resize(size);
    if (!kernel_ || curve != curve_) {
        kernel_ = std::make_unique<vk::Kernel>(make_display_kernel(*device_, curve, blue_first_));
        curve_ = curve;
    }
    kernel_->bind(DISPLAY_BINDING_IMAGE, image);
    kernel_->bind(DISPLAY_BINDING_OVERLAY, *overlay_);
    kernel_->bind(DISPLAY_BINDING_PICTURE, *picture_);
    kernel_->bind(DISPLAY_BINDING_SCREEN, *screen_);
    std::ranges::copy(std::as_bytes(std::span(overlay.pixels)), overlay_->mapped());

    const DisplayPush push{.size = size,
                           .image_size = {image.width(), image.height()},
                           .overlay_origin = {overlay.rect.x0, overlay.rect.y0},
                           .overlay_size = {overlay.rect.width(), overlay.rect.height()},
                           .exposure_scale = std::exp2(exposure_ev)};
    const auto groups = [](uint32_t pixels) { return (pixels + WORKGROUP_SIZE - 1) / WORKGROUP_SIZE; };
    commands_.dispatch(*kernel_, std::as_bytes(std::span(&push, 1)), {groups(size.x), groups(size.y), 1});
    commands_.submit_and_wait();
}

}  // namespace candela
