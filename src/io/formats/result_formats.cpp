#include "bough/io/digest.hpp"
#include "result_format.hpp"

namespace bough::io {

// The rows, in the files of the formats.
ResultFormat history_csv();
ResultFormat history_npy();
ResultFormat columns_json();
ResultFormat motion_bin();
ResultFormat states_bin();
ResultFormat paraview();  ///< in builds with BOUGH_WITH_VTK
ResultFormat gltf();
ResultFormat errors_csv_format();
ResultFormat tables_csv();
ResultFormat linear_model();

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
