# What `bough stress` carries along of data/: a source file made of them when configured, so that nothing is copied.
set(stress_files scenarios/andrews_squeezer.json reference/A02_fourbar_N2.csv reference/A02_fourbar_N40.csv
  reference/A03_andrews_iftomm.csv)
set(stress_items "")
foreach(file IN LISTS stress_files)
  set(path "${PROJECT_SOURCE_DIR}/data/${file}")
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${path}")
  file(READ "${path}" text)
  string(APPEND stress_items "      {\"${file}\", R\"bough(${text})bough\"},\n")
endforeach()
set(stress_data "${CMAKE_CURRENT_BINARY_DIR}/stress_data.cpp")
file(CONFIGURE OUTPUT "${stress_data}" CONTENT [[
// Made by src/stress/data_files.cmake.
#include <map>
#include <stdexcept>

#include "bench.hpp"

namespace bough::stress {

const std::string& data_file(const std::string& name) {
  static const std::map<std::string, std::string> files = {
@stress_items@  };
  const auto found = files.find(name);
  if (found == files.end()) throw std::out_of_range("data/" + name + " is not among the files carried along");
  return found->second;
}

}  // namespace bough::stress
]] @ONLY)
