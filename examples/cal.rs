use frictcomp::circle::*;
fn main(){
    let plant = Preset::Stiff.plant();
    for feed in [500.0,1000.0,2000.0,5000.0]{
        let t = std::time::Instant::now();
        let test = CircularTest{circle:Circle{feed,..Circle::default()},model:FrictionModel::Lugre,list:plant_list(&plant.x),plant:plant.clone(),reading:Default::default()};
        let lap=test.run(Job::ALL[0]).unwrap();
        let t1=t.elapsed(); let _=lap;
        let o=test.outcome().unwrap();
        let f=|s:&Side|{let c=s.figures.ccw.as_ref().unwrap(); let w=s.figures.cw.as_ref().unwrap(); format!("gl {:.3} G_mz {:.3}/{:.3} lsc {:.3} F {:.3} {:.3} D {:.4} H {:.4} Gb {:.3} {:?}",s.figures.glitch_max(),c.g_mz,w.g_mz,c.g_lsc,c.f_max.unwrap(),c.f_min.unwrap(),c.d.unwrap(),s.figures.h.unwrap(),s.figures.g_b.unwrap(), c.glitch.iter().map(|g|(g.height*1000.).round()/1000.).collect::<Vec<_>>())};
        println!("{feed} {t1:?} {:?}\n off {}\n on  {}",t.elapsed(),f(&o.off),f(&o.on));
    }
    let mut l=plant_list(&plant.x); l.scaling_factor=-1000;
    let test = CircularTest{circle:Circle::default(),model:FrictionModel::Lugre,list:l,plant:plant.clone(),reading:Default::default()};
    println!("wrong {}",test.outcome().unwrap().on.figures.glitch_max());
}
