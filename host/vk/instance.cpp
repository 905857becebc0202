// Loads Vulkan, makes the instance and collects the messages of the validation layer.
#include "vk/instance.h"

#include <algorithm>
#include <cstdio>
#include <mutex>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "vk/check.h"

namespace candela::vk {

static constexpr const char* VALIDATION_LAYER = "VK_LAYER_KHRONOS_validation";

// The messages of the validation layer; drivers may call from their own threads.
class MessageLog {
  public:
    void add(std::string message) {
        const std::lock_guard lock(mutex_);
        std::fprintf(stderr, "%s\n", message.c_str());
        messages_.push_back(std::move(message));
    }
    std::vector<std::string> messages() const {
        const std::lock_guard lock(mutex_);
        return messages_;
    }

  private:
    mutable std::mutex mutex_;
    std::vector<std::string> messages_;
};

static VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                                 VkDebugUtilsMessageTypeFlagsEXT,
                                                 const VkDebugUtilsMessengerCallbackDataEXT* data,
                                                 void* log) {
    static_cast<MessageLog*>(log)->add(data->pMessage);
    return VK_FALSE;  // The call that caused the message goes on.
}

// Warnings and errors about our use of Vulkan. We ignore the loader's messages about other drivers, and
// advice on performance, which objects to copies from images in layout GENERAL.
static VkDebugUtilsMessengerCreateInfoEXT messenger_info(MessageLog* log) {
    VkDebugUtilsMessengerCreateInfoEXT info{};
    info.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
    info.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    info.pfnUserCallback = on_message;
    info.pUserData = log;
    return info;
}

static VKAPI_ATTR VkBool32 VKAPI_CALL on_complaint(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                                   VkDebugUtilsMessageTypeFlagsEXT,
                                                   const VkDebugUtilsMessengerCallbackDataEXT* data,
                                                   void* complaints) {
    auto& text = *static_cast<std::string*>(complaints);
    const std::string message = data->pMessage;
    // Leaves out that there is no driver, which is clear, and the loader's claim that a damaged file is a
    // lack of memory.
    std::string said = message.substr(0, message.find(", this is usually because"));
    if (said.ends_with('.')) said.pop_back();
    if (said.find("vkCreateInstance") == std::string::npos) text += (text.empty() ? "" : "; ") + said;
    return VK_FALSE;
}

// The loader's complaints about the files of drivers, in its own words; empty if there are none.
static std::string complaints_of_loader(const VkApplicationInfo& application) {
    std::string complaints;
    VkDebugUtilsMessengerCreateInfoEXT messenger = messenger_info(nullptr);
    messenger.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT;
    messenger.pfnUserCallback = on_complaint;
    messenger.pUserData = &complaints;
    const char* const extension = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
    VkInstanceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    info.pNext = &messenger;
    info.pApplicationInfo = &application;
    info.enabledExtensionCount = 1;
    info.ppEnabledExtensionNames = &extension;
    VkInstance instance = VK_NULL_HANDLE;
    if (vkCreateInstance(&info, nullptr, &instance) == VK_SUCCESS) {
        volkLoadInstance(instance);
        vkDestroyInstance(instance, nullptr);
    }
    return complaints;
}

// Throws the Error for an instance that could not be made, with that result.
static void check_created(VkResult result, const VkApplicationInfo& application) {
    if (result == VK_SUCCESS) return;
    const std::string complaints = complaints_of_loader(application);
    if (!complaints.empty()) {
        throw Error("no Vulkan driver can be loaded: " + complaints +
                        "; repair or remove that file, or install the driver again",
                    ErrorKind::no_device);
    }
    if (result == VK_ERROR_INCOMPATIBLE_DRIVER) {
        throw Error(
            "no Vulkan driver is installed; install the driver of your GPU, or mesa-vulkan-drivers to render "
            "on the CPU",
            ErrorKind::no_device);
    }
    VK_CHECK(result);
}

// The instance extensions of a layer, or, for null, of Vulkan itself.
static std::vector<VkExtensionProperties> instance_extensions(const char* layer) {
    uint32_t count = 0;
    // The loader fails here if it cannot read a driver's file, but says why only when an instance is made.
    if (vkEnumerateInstanceExtensionProperties(layer, &count, nullptr) < 0) return {};
    std::vector<VkExtensionProperties> extensions(count);
    VK_CHECK(vkEnumerateInstanceExtensionProperties(layer, &count, extensions.data()));
    return extensions;
}

static void require_validation_layer() {
    uint32_t count = 0;
    VK_CHECK(vkEnumerateInstanceLayerProperties(&count, nullptr));
    std::vector<VkLayerProperties> layers(count);
    VK_CHECK(vkEnumerateInstanceLayerProperties(&count, layers.data()));
    const bool found = std::any_of(layers.begin(), layers.end(), [](const VkLayerProperties& layer) {
        return std::string_view(layer.layerName) == VALIDATION_LAYER;
    });
    if (!found) {
        throw Error(std::string("validation was asked for, but the Vulkan layer ") + VALIDATION_LAYER +
                    " is missing; install vulkan-validationlayers");
    }
}

// Makes the instance with at least the extensions `required`; with a log, also the validation layer that
// writes to it.
static VkInstance create_instance(const std::vector<std::string>& required, MessageLog* log) {
    VkApplicationInfo application{};
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.pApplicationName = "candela";
    application.apiVersion = VK_API_VERSION_1_2;
    VkInstanceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    info.pApplicationInfo = &application;

    std::vector<const char*> extensions;
    for (const std::string& name : required)
        extensions.push_back(name.c_str());
    if (has_extension(instance_extensions(nullptr), VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME)) {
        extensions.push_back(VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME);
        info.flags |= VK_INSTANCE_CREATE_ENUMERATE_PORTABILITY_BIT_KHR;  // Shows MoltenVK.
    }

    VkDebugUtilsMessengerCreateInfoEXT messenger = messenger_info(log);
    const VkValidationFeatureEnableEXT synchronization =
        VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    VkValidationFeaturesEXT features{};
    features.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT;
    features.enabledValidationFeatureCount = 1;
    features.pEnabledValidationFeatures = &synchronization;
    if (log != nullptr) {
        require_validation_layer();
        extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
        info.pNext = &messenger;  // For messages about the creation of the instance itself.
        info.enabledLayerCount = 1;
        info.ppEnabledLayerNames = &VALIDATION_LAYER;
        if (has_extension(instance_extensions(VALIDATION_LAYER), VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME)) {
            extensions.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);
            messenger.pNext = &features;
        }
    }
    info.enabledExtensionCount = uint32_t(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();

    VkInstance instance = VK_NULL_HANDLE;
    check_created(vkCreateInstance(&info, nullptr, &instance), application);
    return instance;
}

Instance::Instance(const Options& options) {
    if (volkInitialize() != VK_SUCCESS) {
        throw Error(
            "the Vulkan loader (libvulkan.so.1) is not installed; install libvulkan1, and the driver of your "
            "GPU "
            "or mesa-vulkan-drivers to render on the CPU",
            ErrorKind::no_device);
    }
    if (options.validation) log_ = std::make_unique<MessageLog>();
    VkInstance instance = create_instance(options.extensions, log_.get());
    volkLoadInstance(instance);
    instance_ = {instance, vkDestroyInstance};
    if (log_) {
        const VkDebugUtilsMessengerCreateInfoEXT info = messenger_info(log_.get());
        VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
        VK_CHECK(vkCreateDebugUtilsMessengerEXT(instance, &info, nullptr, &messenger));
        messenger_ = {messenger, vkDestroyDebugUtilsMessengerEXT, instance};
    }
}

Instance::~Instance() = default;

std::vector<DeviceInfo> Instance::devices() const {
    uint32_t count = 0;
    // The loader returns VK_ERROR_INITIALIZATION_FAILED if no driver has a device.
    const VkResult result = vkEnumeratePhysicalDevices(instance_.get(), &count, nullptr);
    if (result == VK_ERROR_INITIALIZATION_FAILED) return {};
    VK_CHECK(result);
    std::vector<VkPhysicalDevice> handles(count);
    VK_CHECK(vkEnumeratePhysicalDevices(instance_.get(), &count, handles.data()));
    std::vector<DeviceInfo> devices;
    for (uint32_t i = 0; i < count; ++i) {
        devices.push_back(query_device(handles[i], i));
    }
    return devices;
}

std::vector<std::string> Instance::validation_messages() const {
    return log_ ? log_->messages() : std::vector<std::string>{};
}

}  // namespace candela::vk
