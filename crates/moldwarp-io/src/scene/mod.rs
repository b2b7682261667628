//! From scene.toml to a checked plan.
