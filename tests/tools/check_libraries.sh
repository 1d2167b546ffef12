#!/bin/sh
# check_libraries.sh PROGRAM   fails if the program loads, directly or through another library, a library whose licence
# or whose BLAS it must not depend on.
set -eu
libraries=$(ldd "$1")
echo "$libraries"
if echo "$libraries" | grep -E 'not found|libcholmod|libumfpack|libspqr|libblas|liblapack|libopenblas'; then
  echo "must not be there (or is not found): the lines above"
  exit 1
fi
