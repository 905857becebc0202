# The toolchain for Windows on x86-64, as Debian has it: GCC with the threads of POSIX, which the standard library's are
# made of.
set(CMAKE_SYSTEM_NAME Windows)
set(CMAKE_SYSTEM_PROCESSOR x86_64)
set(CMAKE_C_COMPILER x86_64-w64-mingw32-gcc-posix)
set(CMAKE_CXX_COMPILER x86_64-w64-mingw32-g++-posix)
set(CMAKE_RC_COMPILER x86_64-w64-mingw32-windres)
# Those of binutils take 200 times as long to list what is in an archive.
set(CMAKE_AR llvm-ar)
set(CMAKE_RANLIB llvm-ranlib)
# Without optimization, sources of ours have more functions than an object holds otherwise.
set(CMAKE_CXX_FLAGS_INIT -Wa,-mbig-obj)
# Nothing that the build machine has of its own may be found, but its programs.
set(CMAKE_FIND_ROOT_PATH /usr/x86_64-w64-mingw32 ${CMAKE_CURRENT_LIST_DIR}/../build/windows/root)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
