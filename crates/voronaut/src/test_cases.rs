//! How many cases property tests try.

use proptest::test_runner::Config;

/// What a property test runs with that needs so many cases; where the environment names a number, as in `PROPTEST_CASES=10000`,
/// that one counts. (`Config::with_cases` knows nothing of it.)
pub(crate) fn cases(count: u32) -> Config {
    let named = Config::default();
    let cases = if std::env::var_os("PROPTEST_CASES").is_some() { named.cases } else { count };
    // Cases that assumptions rule out are more where there are more cases.
    Config { cases, max_global_rejects: named.max_global_rejects.max(cases), ..named }
}
