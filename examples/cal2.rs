use frictcomp::circle::*;
use frictcomp::lists::TablePoint;
fn main(){
    let plant = Preset::Stiff.plant();
    let mk=|ins:Vec<f64>|{let mut l=plant_list(&plant.x); l.table=ins.iter().map(|&i|{let s=i*1e-6;let f=&plant.x.friction;TablePoint{input:i,output:(f.level(s)+f.viscous*s)/5.0}}).collect();l};

    let rnd=|mut l:frictcomp::lists::FrictionList|{for p in &mut l.table{p.output=p.output.round();} l};
    let rnd1=|mut l:frictcomp::lists::FrictionList|{for p in &mut l.table{p.output=(p.output*10.).round()/10.;} l};
    let pw=|e:f64,top:f64|mk((0..20).map(|i|((i as f64/19.).powf(e)*top).round()).collect());
    let lists=vec![
     ("round log",rnd(plant_list(&plant.x))),("round1 log",rnd1(plant_list(&plant.x))),
     ("quad",pw(2.,100000.)),("1.5",pw(1.5,100000.)),("1.5, 85",pw(1.5,85000.)),("3, 100",pw(3.,100000.)),("2,200",pw(2.,200000.)),("2,500",pw(2.,500000.)),("3,500",pw(3.,500000.)),("2.5,500",pw(2.5,500000.)),
     ("quad round",rnd(pw(2.,100000.))),
     ("geo 1000..100k+0",mk(std::iter::once(0.0).chain((0..19).map(|i|1000.*100f64.powf(i as f64/18.))).collect())),
     ("geo 500..100k+0",mk(std::iter::once(0.0).chain((0..19).map(|i|500.*200f64.powf(i as f64/18.))).collect())),
     ("geo 200..100k+0",mk(std::iter::once(0.0).chain((0..19).map(|i|200.*500f64.powf(i as f64/18.))).collect())),
     ("geo 100..50k+0",mk(std::iter::once(0.0).chain((0..19).map(|i|100.*500f64.powf(i as f64/18.))).collect())),
     ("geo 100..20k+0",mk(std::iter::once(0.0).chain((0..19).map(|i|100.*200f64.powf(i as f64/18.))).collect())),
     ("geo 100..40k+0",mk(std::iter::once(0.0).chain((0..19).map(|i|100.*400f64.powf(i as f64/18.))).collect())),
    ];
    for (n,l) in lists { print!("{n}: ");
    for feed in [2000.0,5000.0]{
        let test = CircularTest{circle:Circle{feed,..Circle::default()},model:FrictionModel::Lugre,list:l.clone(),plant:plant.clone(),reading:Default::default()};
        let o=Outcome::of([test.run(Job::ALL[2]).unwrap()]);
        print!(" {:.3}",o.on.figures.glitch_max());
    } println!();}
}
