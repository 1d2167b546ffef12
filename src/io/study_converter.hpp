#pragma once
/// Converts a checked document to a study.
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bough/io/read_study.hpp"
#include "scene_converter.hpp"

namespace bough::io {

class StudyConverter : public SceneConverter {
 public:
  StudySpec spec;

  StudyConverter(std::string_view text, std::filesystem::path folder) : SceneConverter(text, std::move(folder)) {}

  void convert(const JsonValue& root);

 private:
  static const Value* sound(const Value& object, const char* key) {
    const Value* v = object.find(key);
    return v != nullptr && v->sound ? v : nullptr;
  }

  // The scene (read_study.cpp).
  void read_base(const Value& root);
  std::vector<std::string> read_settings(const Value& list, const std::string& at);
  static void add_origins(const std::vector<std::string>& overrides, const std::string& at,
                          std::vector<SettingOrigin>& origins);

  // The quantities compared (read_study_quantities.cpp).
  void read_quantity(const Value& v, const std::string& at);
  bool find_columns(const Value& v, const std::string& at, StudyQuantity& q);
  void read_formula(const Value& v, const std::string& at, StudyQuantity& q);
  void read_table(const Value& v, const std::string& at, StudyQuantity& q);

  // The settings varied (read_study_grids.cpp).
  StudyReference read_reference(const Value& v, const std::string& at);
  void read_grid(const Value& v, const std::string& at);
  StudyAxis read_axis(const Value& v, const std::string& at);
  std::optional<StudyChoice> read_value(const std::string& name, const std::string& pointer, const Value& v,
                                        const std::string& at, const std::string& pointer_at);
  void read_orders(const Value& list, const std::string& at, StudyGrid& grid);
  void check_runs(const StudyGrid& grid, const std::string& at);
  bool check_samples(const scene::Scene& scene, const std::string& at);

  std::optional<scene::Scene> base_;  ///< the scene with the settings common to all runs
  std::vector<std::string> columns_;  ///< of its history
};

}  // namespace bough::io
