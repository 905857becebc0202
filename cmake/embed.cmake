# cmake -DINPUT=x.spv -DOUTPUT=x.cpp -DNAME=x -P embed.cmake: writes the words of a SPIR-V file as a C++ array.
file(READ ${INPUT} hex HEX)
string(REGEX REPLACE "(..)(..)(..)(..)" "0x\\4\\3\\2\\1,\n" words "${hex}")
file(WRITE ${OUTPUT} "// Generated from ${NAME}.comp.glsl.
#include <cstdint>
#include <span>
namespace candela::kernels {
static constexpr std::uint32_t ${NAME}_words[] = {\n${words}};
extern const std::span<const std::uint32_t> ${NAME};
const std::span<const std::uint32_t> ${NAME}{${NAME}_words};
}\n")
