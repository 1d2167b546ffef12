#include "matrix_file.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cctype>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>

#include "bough/blocks/at.hpp"
#include "bough/solve/matrix_blocks.hpp"

namespace bough::bench {

namespace {

/// The lines of a file, counted.
class Lines {
 public:
  explicit Lines(const std::filesystem::path& file) : name_(file.string()), in_(file) {
    if (!in_) throw std::runtime_error(name_ + ": the file cannot be read");
  }
  [[noreturn]] void reject(const std::string& why) const {
    throw std::runtime_error(name_ + ":" + std::to_string(number_) + ": " + why);
  }
  /// The next line; false at the end of the file.
  bool next(std::string& line) {
    ++number_;
    return static_cast<bool>(std::getline(in_, line));
  }
  /// The next line that is neither empty nor a comment.
  std::istringstream next_data(const char* expected) {
    std::string line;
    while (next(line))
      if (!line.starts_with('%') && line.find_first_not_of(" \t\r") != std::string::npos)
        return std::istringstream(line);
    reject(std::string("the file ends, expected ") + expected);
  }

 private:
  std::string name_;
  std::ifstream in_;
  long number_ = 0;
};

bool is_definite(const SparseMatrix& a) {
  using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;
  const Eigen::Map<const Matrix> whole(a.n, a.n, a.num_entries(), a.column_begin.data(), a.row.data(), a.value.data());
  const Eigen::SimplicialLLT<Matrix> factor(whole);
  return factor.info() == Eigen::Success;
}

}  // namespace

MatrixFile read_matrix_file(const std::filesystem::path& file) {
  Lines lines(file);
  std::string line;
  if (!lines.next(line)) lines.reject("the file is empty");
  std::transform(line.begin(), line.end(), line.begin(), [](unsigned char c) { return std::tolower(c); });
  std::istringstream head(line);
  std::string banner, object, format, field, symmetry;
  head >> banner >> object >> format >> field >> symmetry;
  if (banner != "%%matrixmarket" || object != "matrix" || format != "coordinate" ||
      (field != "real" && field != "integer") || (symmetry != "general" && symmetry != "symmetric"))
    lines.reject("expected '%%MatrixMarket matrix coordinate real', then 'general' or 'symmetric'");
  MatrixFile out;
  out.is_symmetric = symmetry == "symmetric";
  long rows = 0, columns = 0, count = 0;
  if (!(lines.next_data("the numbers of rows, columns and entries") >> rows >> columns >> count) || rows < 1 ||
      rows != columns || rows > 100'000'000 || count < 0)
    lines.reject("expected the numbers of rows, columns and entries of a square matrix");
  std::vector<std::map<int, double>> entries(at(rows));  // by column
  for (long k = 0; k < count; ++k) {
    long i = 0, j = 0;
    double a = 0.0;
    if (!(lines.next_data("an entry") >> i >> j >> a) || i < 1 || i > rows || j < 1 || j > rows)
      lines.reject("expected row, column and value of an entry, counted from 1");
    if (a == 0.0) continue;
    entries[at(j - 1)][static_cast<int>(i - 1)] += a;
    if (out.is_symmetric && i != j) entries[at(i - 1)][static_cast<int>(j - 1)] += a;
  }
  out.matrix.n = static_cast<int>(rows);
  out.matrix.column_begin.assign(1, 0);
  for (const auto& column : entries) {
    for (const auto& [row, a] : column) {
      out.matrix.row.push_back(row);
      out.matrix.value.push_back(a);
    }
    out.matrix.column_begin.push_back(out.matrix.num_entries());
  }
  return out;
}

Problem make_problem(const std::filesystem::path& file) {
  MatrixFile read = read_matrix_file(file);
  Problem p;
  p.name = file.stem().string();
  p.values = read.is_symmetric ? Values::symmetric : Values::unsymmetric;
  p.matrix = std::move(read.matrix);
  p.is_scaled = false;
  p.is_definite = p.is_symmetric() && is_definite(p.matrix);
  p.rhs.assign(at(p.matrix.n), 0.0);
  for (std::size_t k = 0; k < p.matrix.row.size(); ++k) p.rhs[at(p.matrix.row[k])] += p.matrix.value[k];
  solve::MatrixBlocks blocks = solve::find_blocks(p.matrix);
  p.graph = std::move(blocks.graph);
  p.unknown_begin = std::move(blocks.unknown_begin);
  p.place = std::move(blocks.place);
  return p;
}

}  // namespace bough::bench
