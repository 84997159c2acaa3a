#!/bin/sh
# Runs a script with the Python that tools/setup makes for these tests; 77 (skipped) where it was not made.
# usage: with_python.sh PYTHON SCRIPT [ARGUMENT]...
if [ ! -x "$1" ]; then
  echo "skipped: there is no $1 (tools/setup makes it)"
  exit 77
fi
exec "$@"
