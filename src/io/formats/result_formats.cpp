#include "bough/io/digest.hpp"
#include "result_format.hpp"

namespace bough::io {

const std::vector<ResultFormat>& result_formats() {
  static const std::vector<ResultFormat> formats = {
      history_csv(), history_npy(),       columns_json(), motion_bin(),   states_bin(),
#ifdef BOUGH_HAS_VTK
      paraview(),
#endif
      gltf(),        errors_csv_format(), tables_csv(),   linear_model(),
  };
  return formats;
}

std::string ResultWriter::put(const std::string& name, std::string_view text, const ListFile& list) const {
  write_file(folder_ / name, text, Durability::soon);
  list({name, text.size(), digest_of(text)});
  return name;
}

}  // namespace bough::io
