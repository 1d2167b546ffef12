# Writes OUT, a C++ source with the texts FILES (joined in order) as `extern const std::string_view NAME` of namespace
# NAMESPACE (bough::report if not given). Bytes, not a literal: compilers limit the length of those.
#   cmake -DOUT=file.cpp -DNAME=view_script "-DFILES=a.js;b.js" -P EmbedText.cmake
# With BASE each text is preceded by a line with a file separator (byte 1c) and its path from that folder.
if(NOT DEFINED NAMESPACE)
  set(NAMESPACE bough::report)
endif()
set(hex "")
foreach(file IN LISTS FILES)
  if(DEFINED BASE)
    file(RELATIVE_PATH name "${BASE}" "${file}")
    string(HEX "${name}" name)
    string(APPEND hex "1c${name}0a")
  endif()
  file(READ "${file}" part HEX)
  string(APPEND hex "${part}")
endforeach()
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${hex}")
file(WRITE "${OUT}.new" "#include <string_view>
namespace ${NAMESPACE} {
namespace {
constexpr unsigned char bytes[] = {${bytes}};
}
extern const std::string_view ${NAME};
const std::string_view ${NAME}{reinterpret_cast<const char*>(bytes), sizeof bytes};
}  // namespace ${NAMESPACE}
")
execute_process(COMMAND ${CMAKE_COMMAND} -E copy_if_different "${OUT}.new" "${OUT}")
file(REMOVE "${OUT}.new")
