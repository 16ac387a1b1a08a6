// fascicle-bench: what the parts cost, by Google Benchmark (--benchmark_filter, --benchmark_format=json, ...).
#include <benchmark/benchmark.h>

BENCHMARK_MAIN();
