// a geometry that is not meshed
