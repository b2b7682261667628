//! How far apart particles are where they are: what size to draw them.

/// The distance to the sixth neighbour is that of particles of this spacing in a cubic grid; particles
/// that fill a volume otherwise have about the same.
const NEIGHBOURS: usize = 6;

/// For each point the distance to its sixth nearest neighbour, or to the farthest if there are fewer; 0
/// if it is alone.
pub fn spacings(points: &[[f64; 3]]) -> Vec<f64> {
    let mut order: Vec<u32> = (0..points.len() as u32).collect();
    sort(&mut order, points, 0);
    let nearest = |p: &[f64; 3]| {
        // The point itself is among them.
        let mut best = Vec::with_capacity(NEIGHBOURS + 2);
        search(&order, points, 0, p, &mut best);
        best.last().map_or(0.0, |d: &f64| d.sqrt())
    };
    points.iter().map(nearest).collect()
}

/// Makes a k-d tree of a list: the middle of each range parts it along one axis.
fn sort(order: &mut [u32], points: &[[f64; 3]], axis: usize) {
    if order.len() < 2 {
        return;
    }
    let middle = order.len() / 2;
    let along = |&i: &u32| points[i as usize][axis];
    order.select_nth_unstable_by(middle, |a, b| along(a).total_cmp(&along(b)));
    let (low, high) = order.split_at_mut(middle);
    sort(low, points, (axis + 1) % 3);
    sort(&mut high[1..], points, (axis + 1) % 3);
}

/// Keeps the squares of the least distances, in order.
fn search(order: &[u32], points: &[[f64; 3]], axis: usize, p: &[f64; 3], best: &mut Vec<f64>) {
    let Some(&here) = order.get(order.len() / 2) else {
        return;
    };
    let q = &points[here as usize];
    let square: f64 = (0..3).map(|d| (p[d] - q[d]) * (p[d] - q[d])).sum();
    let full = |best: &[f64]| best.len() > NEIGHBOURS;
    if !full(best) || best.last().is_some_and(|&worst| square < worst) {
        best.insert(best.partition_point(|&b| b < square), square);
        best.truncate(NEIGHBOURS + 1);
    }
    let (low, high) = (&order[..order.len() / 2], &order[order.len() / 2 + 1..]);
    let side = p[axis] - q[axis];
    let (near, far) = if side < 0.0 { (low, high) } else { (high, low) };
    let next = (axis + 1) % 3;
    search(near, points, next, p, best);
    if !full(best) || best.last().is_none_or(|&worst| side * side < worst) {
        search(far, points, next, p, best);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inside_a_grid_it_is_the_grids_spacing() {
        let n = 7;
        let points: Vec<[f64; 3]> = (0..n * n * n)
            .map(|i| [i % n, i / n % n, i / (n * n)].map(|k| 0.25 * f64::from(k)))
            .collect();
        let all = spacings(&points);
        let middle = (3 * n * n + 3 * n + 3) as usize;
        assert!((all[middle] - 0.25).abs() < 1e-12);
        // By trying all.
        for (i, p) in points.iter().enumerate() {
            let square = |q: &[f64; 3]| (0..3).map(|d| (p[d] - q[d]).powi(2)).sum::<f64>();
            let mut squares: Vec<f64> = points.iter().map(square).collect();
            squares.sort_by(f64::total_cmp);
            assert!((all[i] - squares[NEIGHBOURS].sqrt()).abs() < 1e-12);
        }
        assert_eq!(spacings(&[[1.0; 3]]), [0.0]);
        assert!(spacings(&[]).is_empty());
    }
}
