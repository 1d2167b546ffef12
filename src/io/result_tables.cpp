#include "result_tables.hpp"

#include "bough/io/history.hpp"
#include "bough/io/number_text.hpp"

namespace bough::io {

std::string file_of(const records::Table& table) { return table.name + ".csv"; }

std::string table_csv(const records::Table& table) {
  std::string text;
  for (const records::Table::Column& column : table.columns)
    text += (text.empty() ? "" : ",") +
            csv_field(column.unit.empty() ? column.name : column.name + " [" + column.unit + "]");
  text += '\n';
  for (const auto& row : table.rows) {
    for (std::size_t c = 0; c < row.size(); ++c) {
      if (c > 0) text += ',';
      if (const double* number = std::get_if<double>(&row[c]))
        append_number(text, *number);
      else
        text += csv_field(std::get<std::string>(row[c]));
    }
    text += '\n';
  }
  return text;
}

void write_tables(JsonText& json, const std::vector<records::Table>& tables) {
  if (tables.empty()) return;
  json.key("tables");
  json.begin_object();
  for (const records::Table& table : tables) {
    json.key(table.name);
    json.begin_object();
    json.member("about", std::string_view(table.about));
    json.key("columns");
    json.begin_array();
    for (const records::Table::Column& column : table.columns) {
      json.begin_object();
      json.member("name", std::string_view(column.name));
      if (!column.unit.empty()) json.member("unit", std::string_view(column.unit));
      json.member("brief", column.is_brief);
      json.end_object();
    }
    json.end_array();
    json.key("rows");
    json.begin_array();
    for (const auto& row : table.rows) {
      json.begin_object();
      for (std::size_t c = 0; c < row.size(); ++c) {
        json.key(table.columns[c].name);
        if (const double* number = std::get_if<double>(&row[c]))
          json.value(*number);
        else
          json.value(std::string_view(std::get<std::string>(row[c])));
      }
      json.end_object();
    }
    json.end_array();
    json.end_object();
  }
  json.end_object();
}

namespace {

std::string cell_text(const JsonValue& object, std::string_view key) {
  const JsonValue* value = object.find(key);
  return value != nullptr && value->is(JsonKind::string) ? value->text.str() : std::string();
}

}  // namespace

std::vector<records::Table> read_tables(const JsonValue& tables) {
  std::vector<records::Table> list;
  for (std::size_t t = 0; t < tables.items.size(); ++t) {
    const JsonValue &item = tables.items[t], *columns = item.find("columns"), *rows = item.find("rows");
    if (columns == nullptr || rows == nullptr) continue;
    records::Table table{std::string(tables.items.key(t)), cell_text(item, "about")};
    for (const JsonValue& column : columns->items) {
      const JsonValue* brief = column.find("brief");
      table.columns.push_back({cell_text(column, "name"), cell_text(column, "unit"), brief != nullptr && brief->truth});
    }
    for (const JsonValue& given : rows->items) {
      std::vector<records::Table::Cell> row;
      for (const records::Table::Column& column : table.columns) {
        const JsonValue* value = given.find(column.name);
        if (value != nullptr && value->is(JsonKind::number))
          row.emplace_back(value->number);
        else
          row.emplace_back(cell_text(given, column.name));
      }
      table.rows.push_back(std::move(row));
    }
    list.push_back(std::move(table));
  }
  return list;
}

}  // namespace bough::io
