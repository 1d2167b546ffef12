#include <exception>
#include <iostream>
#include <new>

#include "arguments.hpp"
#include "bough/io/manifest.hpp"
#include "standard_streams.hpp"

namespace {

/// Whatever was not foreseen still ends in a sentence and a status.
int dispatch_guarded(int count, char** values) {
  try {
    return bough::app::dispatch(count, values);
  } catch (const std::bad_alloc&) {
    std::cerr << "bough: out of memory\n";
  } catch (const bough::io::OutputRefused& error) {
    std::cerr << "bough: " << error.what() << "\n";
    return bough::app::exit_bad_input;
  } catch (const std::exception& error) {
    std::cerr << "bough: " << error.what() << "\n";
  }
  return bough::app::exit_failed;
}

}  // namespace

int main(int count, char** values) {
  bough::app::hold_standard_descriptors();
  bough::app::ignore_signals_of_writes();
  bough::app::StandardStreams streams;
  return streams.finish(dispatch_guarded(count, values));
}
