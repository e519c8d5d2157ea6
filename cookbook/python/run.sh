#!/usr/bin/env bash
set -euo pipefail
"${PYTHON:-python3}" sink.py | tee speed.tsv
