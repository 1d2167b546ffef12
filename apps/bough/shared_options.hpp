#pragma once
/// Options that several verbs have. This header and dispatch.cpp are all that knows CLI11.
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace bough::app {

/// A finite number from low to high. (CLI::Range lets NaN pass.)
CLI::Validator between(double low, double high);

void add_overrides(CLI::App& verb, std::vector<std::string>& overrides);
/// Decisions of the plan that are not to be taken: an override of /without, made when all are known.
void add_without(CLI::App& verb, std::vector<std::string>& overrides);
/// Errors of the results, measured by twins of a run: overrides of /analysis/errors.
void add_errors(CLI::App& verb, std::vector<std::string>& overrides);
/// Scenes of which a run would take more are refused before anything is allocated for them.
void add_memory_limit(CLI::App& verb, double& bytes, const std::string& what = "a run");
void add_threads(CLI::App& verb, int& threads, const std::string& what);
CLI::Option* add_replace(CLI::App& verb, bool& replace);

CLI::App& add_verb(CLI::App& app, const std::string& name, const std::string& what, const std::string& examples);

}  // namespace bough::app
