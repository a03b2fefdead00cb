//! Light transport over any nest.
