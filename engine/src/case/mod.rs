//! Case files: the only module that knows every name.
