use super::*;

/// Numbers in [-1, 1] that look random (Knuth's multiplier).
fn numbers(mut seed: u64) -> impl FnMut() -> f64 {
    move || {
        seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// A block of a matrix, and its transpose at (column, row).
struct Block {
    row: u32,
    column: u32,
    value: DMat3,
}

fn factor(points: &[DVec3], blocks: &[Block]) -> Option<Cholesky> {
    let clique = |block: &Block| match block.row == block.column {
        true => [NO_NODE, block.row, NO_NODE, NO_NODE],
        false => [NO_NODE, block.row, NO_NODE, block.column],
    };
    let cliques: Vec<Clique> = blocks.iter().map(clique).collect();
    let values = |number: usize| {
        let Block { row, column, value } = blocks[number];
        let mut values = [[DMat3::NAN; 4]; 4];
        match row == column {
            true => values[1][1] = value,
            false => {
                (values[1][1], values[3][3]) = (DMat3::ZERO, DMat3::ZERO);
                (values[1][3], values[3][1]) = (value, value.transpose());
            }
        }
        values
    };
    Elimination::new(points, &cliques).factor(&values)
}

/// Points in a cube, and a matrix that joins near ones; positive definite as its diagonal outweighs
/// the rest of each row.
fn random_matrix(nodes: usize, seed: u64) -> (Vec<DVec3>, Vec<Block>) {
    let mut number = numbers(seed);
    let points: Vec<DVec3> = (0..nodes)
        .map(|_| DVec3::new(number(), number(), number()))
        .collect();
    let mut blocks = Vec::new();
    for row in 0..nodes {
        for column in 0..row {
            if points[row].distance(points[column]) < 0.5 {
                let value = DMat3::from_cols_array(&std::array::from_fn(|_| number()));
                let (row, column) = (row as u32, column as u32);
                // In halves, and either way round.
                blocks.push(Block {
                    row,
                    column,
                    value: value * 0.5,
                });
                let value = value.transpose() * 0.5;
                blocks.push(Block {
                    row: column,
                    column: row,
                    value,
                });
            }
        }
        let value = DMat3::IDENTITY * 3.0 * nodes as f64;
        blocks.push(Block {
            row: row as u32,
            column: row as u32,
            value,
        });
    }
    (points, blocks)
}

fn dense(nodes: usize, blocks: &[Block]) -> Vec<Vec<f64>> {
    let mut matrix = vec![vec![0.0; 3 * nodes]; 3 * nodes];
    for block in blocks {
        for i in 0..3 {
            for j in 0..3 {
                let (row, column) = (3 * block.row as usize + i, 3 * block.column as usize + j);
                matrix[row][column] += block.value.col(j)[i];
                if block.row != block.column {
                    matrix[column][row] += block.value.col(j)[i];
                }
            }
        }
    }
    matrix
}

/// Gauss's elimination, as in a textbook.
fn eliminate(mut matrix: Vec<Vec<f64>>, mut x: Vec<f64>) -> Vec<f64> {
    for k in 0..x.len() {
        let pivot = matrix[k].clone();
        for row in k + 1..x.len() {
            let factor = matrix[row][k] / pivot[k];
            for (value, p) in matrix[row].iter_mut().zip(&pivot).skip(k) {
                *value -= factor * p;
            }
            x[row] -= factor * x[k];
        }
    }
    for k in (0..x.len()).rev() {
        let after = matrix[k].iter().zip(&x).skip(k + 1);
        let known: f64 = after.map(|(value, x)| value * x).sum();
        x[k] = (x[k] - known) / matrix[k][k];
    }
    x
}

#[test]
fn sparse_factor_solves_as_dense_elimination_does() {
    for nodes in [1, 2, 20, 75, 150] {
        let (points, blocks) = random_matrix(nodes, nodes as u64);
        let factor = factor(&points, &blocks).unwrap();
        let mut number = numbers(7);
        let right: Vec<[f64; 2]> = (0..3 * nodes).map(|_| [number(), 0.0]).collect();
        let mut solved = right.clone();
        factor.solve(&mut solved);
        let expected = eliminate(dense(nodes, &blocks), right.iter().map(|r| r[0]).collect());
        for (x, expected) in solved.iter().zip(expected) {
            assert!(
                (x[0] - expected).abs() < 1e-14 && x[1] == 0.0,
                "{nodes} nodes"
            );
        }
    }
}

#[test]
fn dense_factor_of_any_size_solves_as_elimination_does() {
    let mut number = numbers(3);
    for size in (1..20).chain([63, 64, 131, 300]) {
        let numbers: Vec<f64> = (0..size * size).map(|_| number()).collect();
        let element = |row: usize, column: usize| match row == column {
            true => size as f64,
            false => numbers[row.max(column) * size + row.min(column)],
        };
        let rows = (0..size).map(|i| (0..size).map(|j| element(i, j)).collect());
        let matrix: Vec<Vec<f64>> = rows.collect();
        let factor = Columns::from_fn(size, element).factor().unwrap();
        let mut x: Vec<[f64; 1]> = (0..size).map(|_| [number()]).collect();
        let expected = eliminate(matrix, x.iter().map(|x| x[0]).collect());
        factor.forward(&mut x);
        factor.backward(&mut x);
        for (x, expected) in x.iter().zip(expected) {
            assert!((x[0] - expected).abs() < 1e-13, "{size} rows");
        }
    }
}

#[test]
fn a_matrix_that_is_not_positive_definite_has_no_factor() {
    let (points, mut blocks) = random_matrix(60, 5);
    let value = DMat3::from_diagonal(DVec3::new(0.0, 0.0, -1e3));
    blocks.push(Block {
        row: 31,
        column: 31,
        value,
    });
    assert!(factor(&points, &blocks).is_none());
    assert!(
        Columns::from_fn(9, |i, j| (i * j + 1) as f64)
            .factor()
            .is_none()
    );
    assert!(Columns::from_fn(2, |_, _| f64::NAN).factor().is_none());
}

#[test]
fn dissection_parts_a_grid_by_its_smallest_layer() {
    let grid = |i: u32| DVec3::new(f64::from(i % 9), f64::from(i / 9 % 9), f64::from(i / 81));
    let points: Vec<DVec3> = (0..729).map(grid).collect();
    let all = (0..729_u32).flat_map(|a| (0..a).map(move |b| (a, b)));
    let near = all.filter(|&(a, b)| grid(a).distance(grid(b)) < 1.1);
    let near: Vec<Clique> = near.map(|(a, b)| [a, NO_NODE, b, NO_NODE]).collect();
    let groups = dissection::dissect(&points, &Neighbors::new(729, &near));
    let last = groups.last().unwrap();
    // Across the body diagonal; along the axes a layer has 81 nodes.
    assert_eq!(last.nodes.len(), 61);
    let mut nodes: Vec<u32> = groups.iter().flat_map(|g| g.nodes.clone()).collect();
    nodes.sort_unstable();
    assert!(nodes.into_iter().eq(0..729));
}
