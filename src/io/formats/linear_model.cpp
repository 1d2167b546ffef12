/// A linear model (records::LinearModel).
///   linear_model.json         all of it
///   linear_model_A.mtx ...    matrices of the descriptor form, Matrix Market
///   linear_model.npz          arrays of NumPy: A, B, C, D, T of the minimal form, and E_row, E_column, E_value, E_shape
///                             ... of the descriptor form
#include "bough/records/linear_model.hpp"

#include <zlib.h>

#include <array>
#include <cstdint>

#include "bough/io/json_text.hpp"
#include "bough/io/matrix_market.hpp"
#include "result_format.hpp"

namespace bough::io {

namespace {

using records::DenseMatrix;
using records::LinearModel;
using records::LinearVariable;
using records::SparseEntries;

using NamedSparse = std::array<std::pair<char, const SparseEntries*>, 5>;
NamedSparse descriptor_of(const LinearModel& model) {
  return {{{'E', &model.E}, {'A', &model.A}, {'B', &model.B}, {'C', &model.C}, {'D', &model.D}}};
}
using NamedDense = std::array<std::pair<char, const DenseMatrix*>, 5>;
NamedDense minimal_of(const LinearModel::Minimal& minimal) {
  return {{{'A', &minimal.A}, {'B', &minimal.B}, {'C', &minimal.C}, {'D', &minimal.D}, {'T', &minimal.T}}};
}

void write_variables(JsonText& json, std::string_view key, const std::vector<LinearVariable>& variables) {
  json.key(key);
  json.begin_array();
  for (const LinearVariable& variable : variables) {
    json.begin_object();
    json.member("name", std::string_view(variable.name));
    if (!variable.unit.empty()) json.member("unit", std::string_view(variable.unit));
    json.end_object();
  }
  json.end_array();
}

template <class List>
void write_model_numbers(JsonText& json, std::string_view key, const List& list) {
  json.key(key);
  json.begin_array();
  for (const auto value : list) {
    if constexpr (std::is_same_v<std::decay_t<decltype(value)>, int>)
      json.value(static_cast<long long>(value));
    else
      json.value(value);
  }
  json.end_array();
}

std::string model_json(const LinearModel& model) {
  JsonText json;
  json.begin_object();
  json.member("about", std::string_view(model.about));
  write_variables(json, "inputs", model.inputs);
  write_variables(json, "outputs", model.outputs);
  json.key("descriptor");
  json.begin_object();
  json.member("equations", "E x' = A x + B u, y = C x + D u");
  write_variables(json, "states", model.states);
  for (const auto& [name, matrix] : descriptor_of(model)) {
    json.key(std::string_view(&name, 1));
    json.begin_object();
    json.member("rows", static_cast<long long>(matrix->rows));
    json.member("columns", static_cast<long long>(matrix->columns));
    write_model_numbers(json, "row", matrix->row);
    write_model_numbers(json, "column", matrix->column);
    write_model_numbers(json, "value", matrix->value);
    json.end_object();
  }
  json.end_object();
  if (!model.why_not_minimal.empty()) {
    json.member("why_not_minimal", std::string_view(model.why_not_minimal));
  } else {
    json.key("minimal");
    json.begin_object();
    json.member("equations", "x' = A x + B u, y = C x + D u, unknowns of the descriptor form T x and a multiple of u");
    write_variables(json, "states", model.minimal.states);
    for (const auto& [name, matrix] : minimal_of(model.minimal)) {
      json.key(std::string_view(&name, 1));
      json.begin_array();
      for (int i = 0; i < matrix->rows; ++i) {
        json.begin_array();
        for (int j = 0; j < matrix->columns; ++j)
          json.value(matrix->value[static_cast<std::size_t>(i) * static_cast<std::size_t>(matrix->columns) +
                                   static_cast<std::size_t>(j)]);
        json.end_array();
      }
      json.end_array();
    }
    json.end_object();
  }
  json.end_object();
  return json.text();
}

/// Numbers with the lowest byte first, as many bytes as they have.
template <class T>
void put_number(std::string& bytes, T value) {
  for (std::size_t k = 0; k < sizeof value; ++k) bytes += static_cast<char>((value >> (8 * k)) & 0xff);
}

/// An array of NumPy, format 1.0; type: "<f8" or "<i8".
template <class T>
std::string npy_array(const char* type, const std::string& shape, const std::vector<T>& values) {
  std::string words = std::string("{'descr': '") + type + "', 'fortran_order': False, 'shape': (" + shape + "), }";
  while ((10 + words.size() + 1) % 64 != 0) words += ' ';
  words += '\n';
  std::string bytes("\x93NUMPY\x01\x00", 8);
  put_number(bytes, static_cast<std::uint16_t>(words.size()));
  bytes += words;
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  return bytes;
}

/// Files one after the other and not compressed, with their list at the end (PKWARE's APPNOTE 6.3).
class ZipArchive {
 public:
  void add(const std::string& name, const std::string& bytes) {
    const auto offset = static_cast<std::uint32_t>(text_.size());
    const auto size = static_cast<std::uint32_t>(bytes.size());
    const auto crc = static_cast<std::uint32_t>(
        crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
    std::string common;
    // Version, flags, stored, 1980-01-01.
    for (const int word : {20, 0, 0, 0, 0x21}) put_number(common, static_cast<std::uint16_t>(word));
    for (const std::uint32_t number : {crc, size, size}) put_number(common, number);
    put_number(common, static_cast<std::uint16_t>(name.size()));
    put_number(common, std::uint16_t{0});
    text_ += "PK\x03\x04" + common + name + bytes;
    list_ += std::string("PK\x01\x02\x14", 5) + std::string(1, '\0') + common;
    for (int k = 0; k < 3; ++k) put_number(list_, std::uint16_t{0});
    put_number(list_, std::uint32_t{0});
    put_number(list_, offset);
    list_ += name;
    ++count_;
  }
  std::string text() const {
    std::string end("PK\x05\x06");
    for (const std::uint16_t word : {std::uint16_t{0}, std::uint16_t{0}, count_, count_}) put_number(end, word);
    put_number(end, static_cast<std::uint32_t>(list_.size()));
    put_number(end, static_cast<std::uint32_t>(text_.size()));
    put_number(end, std::uint16_t{0});
    return text_ + list_ + end;
  }

 private:
  std::string text_, list_;
  std::uint16_t count_ = 0;
};

std::string model_npz(const LinearModel& model) {
  ZipArchive zip;
  for (const auto& [name, matrix] : descriptor_of(model)) {
    const std::string begin = std::string(1, name) + "_", length = std::to_string(matrix->value.size()) + ",";
    const auto whole = [](const std::vector<int>& list) { return std::vector<std::int64_t>(list.begin(), list.end()); };
    zip.add(begin + "row.npy", npy_array("<i8", length, whole(matrix->row)));
    zip.add(begin + "column.npy", npy_array("<i8", length, whole(matrix->column)));
    zip.add(begin + "value.npy", npy_array("<f8", length, matrix->value));
    zip.add(begin + "shape.npy", npy_array("<i8", "2,", std::vector<std::int64_t>{matrix->rows, matrix->columns}));
  }
  if (model.why_not_minimal.empty())
    for (const auto& [name, matrix] : minimal_of(model.minimal))
      zip.add(std::string(1, name) + ".npy",
              npy_array("<f8", std::to_string(matrix->rows) + ", " + std::to_string(matrix->columns), matrix->value));
  return zip.text();
}

class LinearModelFiles final : public ResultWriter {
 public:
  using ResultWriter::ResultWriter;
  std::vector<std::string> commit(const records::Summary& summary, const ListFile& list) override {
    if (!summary.linear_model) return {};
    const LinearModel& model = *summary.linear_model;
    std::vector<std::string> names{put("linear_model.json", model_json(model), list),
                                   put("linear_model.npz", model_npz(model), list)};
    for (const auto& [name, matrix] : descriptor_of(model))
      names.push_back(put(std::string("linear_model_") + name + ".mtx",
                          matrix_market_text(*matrix, {"E x' = A x + B u, y = C x + D u", model.about}), list));
    return names;
  }
};

}  // namespace

ResultFormat linear_model() {
  return {"",
          {"linear_model.json", "linear_model.npz", "linear_model_E.mtx", "linear_model_A.mtx", "linear_model_B.mtx",
           "linear_model_C.mtx", "linear_model_D.mtx"},
          make_writer<LinearModelFiles>,
          ""};
}

}  // namespace bough::io
