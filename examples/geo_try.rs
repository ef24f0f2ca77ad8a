use luminaire::measure::{Workbench, stability::SWEEPS};
fn main() {
    let names: Vec<String> = std::env::args().skip(1).collect();
    let long = names.iter().any(|n| n == "long");
    let bench = Workbench::new(long).unwrap();
    for s in SWEEPS.iter().filter(|s| names.iter().any(|n| n == s.name)) {
        let t = std::time::Instant::now();
        let sweep = (s.run)(&bench).unwrap();
        println!("== {} {:.1} s", s.name, t.elapsed().as_secs_f64());
        for c in &sweep.charts {
            println!("-- {} [{}]", c.title, c.name);
            let xs: Vec<f64> = c.series[0].points.iter().map(|p| p.x).collect();
            print!("{:36}", "");
            for x in &xs {
                print!("{x:>9.1e}");
            }
            println!();
            for s in &c.series {
                print!("{:36}", s.name);
                for x in &xs {
                    match s.points.iter().find(|p| p.x == *x) {
                        Some(p) => print!(
                            "{:>9}",
                            if p.y.abs() < 0.1 && p.y != 0.0 {
                                format!("{:.2e}", p.y)
                            } else {
                                format!("{:.5}", p.y).chars().take(8).collect::<String>()
                            }
                        ),
                        None => print!("{:>9}", "-"),
                    }
                }
                println!();
            }
        }
        println!("{:#?}", sweep.findings);
    }
}
