/// The history as text and as an array, its columns, errors of its columns, and tables.
#include "../measured_errors.hpp"
#include "../result_tables.hpp"
#include "bough/io/columns.hpp"
#include "bough/io/digest.hpp"
#include "bough/io/history.hpp"
#include "bough/io/npy_history.hpp"
#include "result_format.hpp"

namespace bough::io {
namespace {

class HistoryCsv final : public ResultWriter {
 public:
  using ResultWriter::ResultWriter;
  void begin(const records::HistoryHeader& header) override {
    writer_ = std::make_unique<HistoryWriter>(folder() / "history.csv", header);
  }
  void row(const records::HistoryRow& row) override { writer_->row(row); }
  void checkpoint(records::Archive& archive, const records::HistoryHeader& header) override {
    if (archive.is_reading())
      writer_ = std::make_unique<HistoryWriter>(folder() / "history.csv", header, archive);
    else
      archive(*writer_);
  }
  std::vector<std::string> commit(const records::Summary&, const ListFile& list) override {
    return {commit_one(*writer_, list)};
  }

 private:
  std::unique_ptr<HistoryWriter> writer_;
};

class HistoryNpy final : public ResultWriter {
 public:
  using ResultWriter::ResultWriter;
  void begin(const records::HistoryHeader& header) override {
    writer_ = std::make_unique<NpyHistoryWriter>(folder() / "history.npy", header);
  }
  void row(const records::HistoryRow& row) override { writer_->row(row); }
  void checkpoint(records::Archive& archive, const records::HistoryHeader& header) override {
    if (archive.is_reading()) begin(header);
    archive(*writer_);
  }
  std::vector<std::string> commit(const records::Summary&, const ListFile& list) override {
    if (!writer_->has_begun()) return {};
    return {commit_one(*writer_, list)};
  }

 private:
  std::unique_ptr<NpyHistoryWriter> writer_;
};

class ColumnsJson final : public ResultWriter {
 public:
  using ResultWriter::ResultWriter;
  void begin(const records::HistoryHeader& header) override {
    text_ = columns_text(header);
    write_file(folder() / "columns.json", text_, Durability::later);  // for readers while the run goes on
  }
  void checkpoint(records::Archive& archive, const records::HistoryHeader& header) override {
    if (archive.is_reading()) text_ = columns_text(header);
  }
  std::vector<std::string> commit(const records::Summary& summary, const ListFile& list) override {
    if (summary.errors) text_ = columns_text(summary.header, &summary.errors->header);
    // Listed in any case: without errors the same text has stood there since the run began.
    list({"columns.json", text_.size(), digest_of(text_)});
    write_file(folder() / "columns.json", text_, Durability::soon);
    return {"columns.json"};
  }

 private:
  std::string text_;
};

class ErrorsCsv final : public ResultWriter {
 public:
  using ResultWriter::ResultWriter;
  std::vector<std::string> commit(const records::Summary& summary, const ListFile& list) override {
    if (!summary.errors) return {};
    return {put("errors.csv", errors_csv(*summary.errors), list)};
  }
};

class TablesCsv final : public ResultWriter {
 public:
  using ResultWriter::ResultWriter;
  std::vector<std::string> commit(const records::Summary& summary, const ListFile& list) override {
    std::vector<std::string> names;
    for (const records::Table& table : summary.tables) names.push_back(put(file_of(table), table_csv(table), list));
    return names;
  }
};

}  // namespace

ResultFormat history_csv() { return {"", {"history.csv"}, make_writer<HistoryCsv>, ""}; }
ResultFormat history_npy() { return {"", {"history.npy"}, make_writer<HistoryNpy>, ""}; }
ResultFormat columns_json() { return {"", {"columns.json"}, make_writer<ColumnsJson>, ""}; }
ResultFormat errors_csv_format() { return {"", {"errors.csv"}, make_writer<ErrorsCsv>, ""}; }
ResultFormat tables_csv() { return {"", table_files, make_writer<TablesCsv>, ""}; }

}  // namespace bough::io
