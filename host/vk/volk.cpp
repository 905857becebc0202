// The one place that compiles volk, which loads Vulkan's functions at run time.
#define VOLK_IMPLEMENTATION
#include <volk.h>
