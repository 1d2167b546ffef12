#include "context.hpp"

#include <benchmark/benchmark.h>
#include <dlfcn.h>

#include "bough/lanes/instruction_set.hpp"
#include "bough/version.hpp"

namespace bough::bench {

namespace {

/// A function of the BLAS, if the loaded one is OpenBLAS.
template <class F>
F* find(const char* name) {
  return reinterpret_cast<F*>(dlsym(RTLD_DEFAULT, name));
}

std::string file_of(void* symbol) {
  Dl_info info;
  return symbol != nullptr && dladdr(symbol, &info) != 0 ? info.dli_fname : "";
}

}  // namespace

std::string describe_blas() {
  void* dgemm = dlsym(RTLD_DEFAULT, "dgemm_");
  if (dgemm == nullptr) return "none";
  std::string text = file_of(dgemm);
  if (auto* config = find<char*()>("openblas_get_config")) text += std::string(", ") + config();
  if (auto* kind = find<int()>("openblas_get_parallel")) {
    static const char* const kinds[] = {"serial", "pthread", "openmp"};
    const int k = kind();
    text += std::string(", ") + (k >= 0 && k < 3 ? kinds[k] : "unknown");
  }
  if (auto* threads = find<int()>("openblas_get_num_threads")) text += ", threads a call " + std::to_string(threads());
  return text;
}

void set_blas_threads(int threads) {
  if (auto* set_threads = find<void(int)>("openblas_set_num_threads")) set_threads(threads);
}

void add_context() {
  set_blas_threads(1);
  benchmark::AddCustomContext("commit", std::string(commit));
  benchmark::AddCustomContext("compiler", std::string(compiler));
  benchmark::AddCustomContext("flags", std::string(compiler_flags));
  benchmark::AddCustomContext("instruction_set", std::string(lanes::instruction_set().name));
  benchmark::AddCustomContext("blas", describe_blas());
}

}  // namespace bough::bench
