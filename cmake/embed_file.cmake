# cmake -DINPUT=x.exr -DOUTPUT=x_exr.cpp -DNAME=x_exr -P embed_file.cmake: writes the bytes of a file as a C++ string.
file(READ ${INPUT} hex HEX)
string(REGEX REPLACE "(..)" "'\\\\x\\1',\n" bytes "${hex}")
get_filename_component(file ${INPUT} NAME)
file(WRITE ${OUTPUT} "// Generated from ${file}.
#include <string_view>
namespace candela::embedded {
static constexpr char ${NAME}_bytes[] = {\n${bytes}};
extern const std::string_view ${NAME};
const std::string_view ${NAME}{${NAME}_bytes, sizeof ${NAME}_bytes};
}\n")
