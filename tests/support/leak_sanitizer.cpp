// Compiled into the programs of the sanitizer build only: which leaks are not ours but the driver's and
// the validation layer's (Mesa 22.3 and Khronos 1.3.239 leak a little per instance and per submission).

// Frames of a library that was unloaded have no name any more, and no suppression would match them.
extern "C" int dlclose(void*) {
    return 0;
}

extern "C" const char* __lsan_default_suppressions() {
    return "leak:libvulkan_lvp.so\n"
           "leak:libVkLayer_khronos_validation.so\n";
}

extern "C" const char* __lsan_default_options() {
    return "print_suppressions=0";
}
